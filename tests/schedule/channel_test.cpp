#include "engine/schedule/channel.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <memory>
#include <thread>

#include "engine/schedule/worker.h"

namespace lumenline {
namespace {

struct Ends {
    Ends() {
        std::array<int, 2> ends{};
        EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
        a = std::make_unique<Channel>(ends[0]);
        b = std::make_unique<Channel>(ends[1]);
    }
    std::unique_ptr<Channel> a, b;
};

TEST(Channel, MessagesArriveWholeAndInOrder) {
    const Ends ends;
    const std::string large(3'000'000, 'x');  // more than a socket holds
    std::thread sender([&] {
        EXPECT_TRUE(ends.a->send("first"));
        EXPECT_TRUE(ends.a->send(""));
        EXPECT_TRUE(ends.a->send(large));
        EXPECT_TRUE(ends.a->send(std::string("with\0nul", 8)));
    });
    EXPECT_EQ(ends.b->receive(), "first");
    EXPECT_EQ(ends.b->receive(), "");
    EXPECT_EQ(ends.b->receive(), large);
    EXPECT_EQ(ends.b->receive(), std::string("with\0nul", 8));
    sender.join();
}

TEST(Channel, WhatWasSentBeforeTheEndIsReadAndHalfAMessageIsNot) {
    Ends ends;
    std::vector<std::string> messages;
    EXPECT_TRUE(ends.b->take_arrived(messages));
    EXPECT_TRUE(messages.empty());
    EXPECT_TRUE(ends.a->send("whole"));
    ASSERT_EQ(::write(ends.a->descriptor(), "\x9\0\0\0half", 8), 8);
    ends.a.reset();
    EXPECT_FALSE(ends.b->take_arrived(messages));
    EXPECT_EQ(messages, std::vector<std::string>{"whole"});
    EXPECT_FALSE(ends.b->receive());
    EXPECT_FALSE(ends.b->send("to nobody")) << "and no signal";
}

TEST(WorkerNews, ReadBackAsWritten) {
    using Kind = WorkerNews::Kind;
    for (const WorkerNews& news :
         {WorkerNews{}, WorkerNews{Kind::kStage, Stage::kTrace}, WorkerNews{Kind::kLoaded, Stage::kLoad, 1234567, "ab"},
          WorkerNews{Kind::kLoaded, Stage::kLoad, 3, ""}, WorkerNews{Kind::kDone, Stage::kLoad, 0, "5 6 seven"}}) {
        const WorkerNews read = WorkerNews::parse(news.message());
        EXPECT_EQ(read.kind, news.kind);
        EXPECT_EQ(read.stage, news.stage);
        EXPECT_EQ(read.sites, news.sites);
        EXPECT_EQ(read.text, news.text);
    }
}

}  // namespace
}  // namespace lumenline
