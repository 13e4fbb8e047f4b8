#include "engine/schedule/admission.h"

#include <gtest/gtest.h>

namespace lumenline {
namespace {

TEST(Admission, ModelsStartInOrderWithinPlacesAndMemory) {
    Admission queue({4, 4, 4}, 2, 10);
    EXPECT_EQ(queue.next()->model, 0U);
    EXPECT_EQ(queue.next()->model, 1U);
    EXPECT_FALSE(queue.next()) << "no place";
    queue.free_place();
    EXPECT_FALSE(queue.next()) << "no memory: the one that gave its place back still has its own";
    queue.leave(4);
    EXPECT_EQ(queue.next()->model, 2U);
    EXPECT_EQ(queue.waiting(), 0U);
}

TEST(Admission, ModelBeyondAllMemoryRunsAlone) {
    Admission queue({30, 1}, 4, 10);
    EXPECT_EQ(queue.next()->model, 0U);
    EXPECT_FALSE(queue.next());
    queue.free_place();
    queue.leave(30);
    EXPECT_EQ(queue.next()->model, 1U);
}

TEST(Admission, WhatIsKnownLaterIsPutRight) {
    Admission queue({4, 5, 5}, 4, 10);
    EXPECT_TRUE(queue.next());
    queue.correct(4);  // the first needs 8
    EXPECT_FALSE(queue.next());
    queue.correct(-6);  // no, 2
    EXPECT_EQ(queue.next()->model, 1U);
    EXPECT_FALSE(queue.next());
    queue.free_place();
    queue.leave(2);
    EXPECT_EQ(queue.next()->model, 2U);
}

TEST(Admission, SmallerOnesPassOneThatWaitsButNotForEver) {
    Admission queue({9, 10, 1, 1, 1}, 3, 10);
    EXPECT_EQ(queue.next()->model, 0U);
    for (const std::size_t passing : {2U, 3U, 4U}) {
        EXPECT_EQ(queue.would_fit(9), 1U);
        const auto admitted = queue.next();
        ASSERT_TRUE(admitted);
        EXPECT_EQ(admitted->model, passing);
        queue.free_place();
        queue.leave(1);
    }
    EXPECT_FALSE(queue.next());
    EXPECT_EQ(queue.would_fit(9), 0U);
}

TEST(Admission, WithoutABoundOnMemoryPlacesDecide) {
    Admission queue({1e300, 1e300}, 1, 0);
    EXPECT_TRUE(queue.next());
    EXPECT_FALSE(queue.next());
    EXPECT_EQ(queue.would_fit(5), 1U);
}

}  // namespace
}  // namespace lumenline
