#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/errors.h"
#include "engine/schedule/channel.h"

namespace lumenline {

/// This program in a process of its own, as the run sees it. The process ends with this object, and with the thread
/// that made it, however that ends.
class WorkerProcess {
public:
    /// Starts this program anew. Its standard input is the channel, its standard output goes nowhere.
    /// @param arguments  behind the program's name
    /// @throws std::system_error
    explicit WorkerProcess(const std::vector<std::string>& arguments);
    ~WorkerProcess();
    WorkerProcess(const WorkerProcess&) = delete;
    WorkerProcess& operator=(const WorkerProcess&) = delete;

    [[nodiscard]] Channel& channel() { return channel_; }
    /// Waits for the end of a process whose channel is closed. @returns its status as waitpid gives it
    int wait();
    /// Ends the process at once.
    void kill();

private:
    pid_t process_ = -1;
    Channel channel_;
};

/// What a worker tells of a model.
struct WorkerNews {
    enum class Kind : char { kReady = 'r', kStage = 's', kLoaded = 'l', kDone = 'd' };
    Kind kind = Kind::kReady;
    Stage stage = Stage::kLoad;  ///< kStage: that begins
    double sites = 0;            ///< kLoaded: of the surface
    std::string text = {};       ///< kLoaded: SHA-256 of the surface; kDone: the reply

    [[nodiscard]] std::string message() const;
    static WorkerNews parse(std::string_view message);
};

/// The run as a worker process sees it.
class WorkerLink {
public:
    /// To be called first in a worker: takes standard input as the channel, leaves SIGINT and SIGTERM to the run, and
    /// ends this process with the thread that started it.
    WorkerLink();

    /// Waits for the next request; empty if there will be none.
    std::optional<std::string> next_request() { return orphaned_ ? std::nullopt : channel_.receive(); }
    void tell(const WorkerNews& news) { channel_.send(news.message()); }

private:
    Channel channel_;
    bool orphaned_ = false;
};

}  // namespace lumenline
