#pragma once

#include <chrono>
#include <functional>
#include <memory>

namespace lumenline {

/// Calls `tick` again and again from a thread of its own, `period` after the last call ended, as long as it lives.
/// For signs of life and for what must go on while every other thread computes. `tick` must not throw.
class Ticker {
public:
    Ticker(std::chrono::milliseconds period, std::function<void()> tick);
    /// Waits for a call that is under way.
    ~Ticker();
    Ticker(const Ticker&) = delete;
    Ticker& operator=(const Ticker&) = delete;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lumenline
