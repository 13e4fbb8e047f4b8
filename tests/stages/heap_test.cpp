#include "engine/geometry/heap.h"

#include <gtest/gtest.h>

#include <queue>
#include <utility>
#include <vector>

#include "tests/stages/support.h"

namespace lumenline {
namespace {

/// The least entry of a queue with stale entries that still holds.
using Queue = std::priority_queue<std::pair<double, std::uint32_t>, std::vector<std::pair<double, std::uint32_t>>,
                                  std::greater<>>;

TEST(IndexedHeap, PopsInTheOrderOfAPriorityQueueThroughDecreasesAndReturns) {
    constexpr std::uint32_t kItems = 500;
    test::Random random(20);
    IndexedHeap heap;
    for (int round = 0; round < 5; ++round) {
        heap.reset(kItems);
        std::vector<double> key(kItems, 1e9);
        std::vector<bool> present(kItems, false);
        const auto key_of = [&key](std::uint32_t i) { return key[i]; };
        Queue queue;
        std::size_t count = 0;
        for (int step = 0; step < 20000; ++step) {
            if (random.uniform(0, 1) < 0.6 || count == 0) {
                const auto item = static_cast<std::uint32_t>(random.below(kItems));
                key[item] = present[item] ? key[item] - random.uniform(0, 1) : random.uniform(0, 100);
                count += present[item] ? 0 : 1;
                present[item] = true;
                heap.push_or_decrease(item, key_of);
                queue.emplace(key[item], item);
            } else {
                while (!present[queue.top().second] || key[queue.top().second] != queue.top().first) queue.pop();
                const std::uint32_t popped = heap.pop(key_of);
                ASSERT_EQ(popped, queue.top().second);
                present[popped] = false;
                queue.pop();
                --count;
            }
            ASSERT_EQ(heap.empty(), count == 0);
        }
    }
}

TEST(IndexedHeap, EqualKeysComeOutOnceEachInAnOrderThatRepeats) {
    const auto run = [] {
        IndexedHeap heap;
        heap.reset(100);
        const auto key = [](std::uint32_t i) { return static_cast<double>(i % 3); };
        for (std::uint32_t i = 0; i < 100; ++i) heap.push_or_decrease(i, key);
        std::vector<std::uint32_t> order;
        while (!heap.empty()) order.push_back(heap.pop(key));
        return order;
    };
    std::vector<std::uint32_t> order = run();
    EXPECT_EQ(order, run());
    for (std::size_t i = 0; i + 1 < order.size(); ++i) EXPECT_LE(order[i] % 3, order[i + 1] % 3);
    std::sort(order.begin(), order.end());
    for (std::uint32_t i = 0; i < 100; ++i) EXPECT_EQ(order[i], i);
}

TEST(IndexedHeap, ResetForgetsWhatItHeld) {
    IndexedHeap heap;
    const auto key = [](std::uint32_t i) { return static_cast<double>(i); };
    heap.reset(10);
    heap.push_or_decrease(7, key);
    heap.reset(3);
    EXPECT_TRUE(heap.empty());
    heap.push_or_decrease(2, key);
    EXPECT_EQ(heap.pop(key), 2U);
    EXPECT_TRUE(heap.empty());
}

}  // namespace
}  // namespace lumenline
