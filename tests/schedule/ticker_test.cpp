#include "engine/schedule/ticker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "engine/schedule/parallel_each.h"

namespace lumenline {
namespace {

TEST(Ticker, TicksUntilItIsDestroyedAndNoLonger) {
    std::atomic<int> ticks{0};
    {
        const Ticker ticker(std::chrono::milliseconds(1), [&] { ++ticks; });
        while (ticks < 3) std::this_thread::yield();
    }
    const int after = ticks;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(ticks, after);
}

TEST(Ticker, EndsAtOnceWithoutWaitingForItsPeriod) {
    const Ticker ticker(std::chrono::hours(1), [] { FAIL() << "an hour has not passed"; });
}

TEST(ParallelEach, CallsEachOnceAndPassesOnWhatIsThrown) {
    std::vector<std::atomic<int>> calls(1000);
    parallel_each(4, calls.size(), [&](std::size_t i) { ++calls[i]; });
    for (const auto& count : calls) EXPECT_EQ(count, 1);
    EXPECT_THROW(parallel_each(2, 10,
                               [](std::size_t i) {
                                   if (i == 7) throw std::runtime_error("seven");
                               }),
                 std::runtime_error);
    parallel_each(2, 0, [](std::size_t) { FAIL(); });
}

}  // namespace
}  // namespace lumenline
