// A message is its length in four bytes and then its bytes.

#include "engine/schedule/channel.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

namespace lumenline {

namespace {

using Length = std::uint32_t;

/// Bytes that have come, at least one unless told not to wait; 0 = the other end is closed, -1 = none have come.
ssize_t read_some(int descriptor, std::string& bytes, int flags) {
    std::array<char, 65536> buffer;
    ssize_t got = 0;
    do got = ::recv(descriptor, buffer.data(), buffer.size(), flags);
    while (got < 0 && errno == EINTR);
    if (got > 0) bytes.append(buffer.data(), static_cast<std::size_t>(got));
    if (got < 0 && errno != EAGAIN && errno != EWOULDBLOCK) return 0;
    return got;
}

}  // namespace

Channel::~Channel() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

Channel::Channel(Channel&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), arrived_(std::move(other.arrived_)) {}

bool Channel::send(std::string_view message) {
    const auto length = static_cast<Length>(message.size());
    std::string bytes(sizeof length, '\0');
    std::memcpy(bytes.data(), &length, sizeof length);
    bytes.append(message);
    const std::lock_guard lock(sending_);
    for (std::string_view left = bytes; !left.empty();) {
        const ssize_t sent = ::send(descriptor_, left.data(), left.size(), MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent < 0) return false;
        left.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
}

std::optional<std::string> Channel::first_message() {
    Length length = 0;
    if (arrived_.size() < sizeof length) return std::nullopt;
    std::memcpy(&length, arrived_.data(), sizeof length);
    if (arrived_.size() - sizeof length < length) return std::nullopt;
    std::string message = arrived_.substr(sizeof length, length);
    arrived_.erase(0, sizeof length + length);
    return message;
}

std::optional<std::string> Channel::receive() {
    for (;;) {
        if (auto message = first_message()) return message;
        if (read_some(descriptor_, arrived_, 0) <= 0) return std::nullopt;
    }
}

bool Channel::take_arrived(std::vector<std::string>& messages) {
    ssize_t got = 1;
    while (got > 0) got = read_some(descriptor_, arrived_, MSG_DONTWAIT);
    while (auto message = first_message()) messages.push_back(std::move(*message));
    return got < 0;
}

}  // namespace lumenline
