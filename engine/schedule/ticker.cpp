// Not a task of oneTBB: its threads may all be inside stages that take minutes.

#include "engine/schedule/ticker.h"

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

namespace lumenline {

struct Ticker::Impl {
    std::mutex mutex;
    std::condition_variable_any wake;
    std::jthread thread;  // last: it is joined before the others go
};

Ticker::Ticker(std::chrono::milliseconds period, std::function<void()> tick) : impl_(std::make_unique<Impl>()) {
    impl_->thread = std::jthread([impl = impl_.get(), period, tick = std::move(tick)](const std::stop_token& stop) {
        std::unique_lock lock(impl->mutex);
        while (!impl->wake.wait_for(lock, stop, period, [&] { return stop.stop_requested(); })) tick();
    });
}

Ticker::~Ticker() = default;

}  // namespace lumenline
