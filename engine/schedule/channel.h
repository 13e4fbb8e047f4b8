#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lumenline {

/// One end of a stream of messages between two processes. Each message arrives whole or not at all. Owns its
/// descriptor.
class Channel {
public:
    explicit Channel(int descriptor) : descriptor_(descriptor) {}
    ~Channel();
    Channel(Channel&& other) noexcept;
    Channel& operator=(Channel&&) = delete;

    /// Sends a message; several threads may. @returns false if nobody is at the other end
    bool send(std::string_view message);
    /// Waits for the next message; empty if the other end is closed.
    std::optional<std::string> receive();
    /// Adds the messages that have come to `messages`, without waiting. @returns false if the other end is closed
    bool take_arrived(std::vector<std::string>& messages);

    [[nodiscard]] int descriptor() const { return descriptor_; }

private:
    std::optional<std::string> first_message();

    int descriptor_;
    std::string arrived_;  // bytes of messages that are not taken yet
    std::mutex sending_;
};

}  // namespace lumenline
