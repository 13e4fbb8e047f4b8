// Workers are started by posix_spawn: no code of ours, nor of a library, runs between the system's clone and the exec,
// so that it does not matter which locks other threads hold, and no page is copied however large the run is.
// (Boost.Process 1.74 forks, runs its handlers in the child, and forks once more to wait with a time limit.)
//
// A run that is killed must leave no worker that writes: another run may take over its archive at once. Closing the
// channel would be noticed by an idle worker only. So the kernel is asked for a SIGKILL when the parent ends; it sends
// that before the parent's end can be seen by anyone, and no code of the worker runs after it. It watches the thread
// that made the process, which therefore has to live as long as the run.

#include "engine/schedule/worker.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <system_error>

#include "engine/core/text.h"

namespace lumenline {

namespace {

void require(int error, const char* what) {
    if (error != 0) throw std::system_error(error, std::generic_category(), what);
}

/// Descriptors and signals of a child.
class SpawnPlan {
public:
    explicit SpawnPlan(int standard_input) {
        require(::posix_spawn_file_actions_init(&files_), "cannot start a worker");
        require(::posix_spawnattr_init(&attributes_), "cannot start a worker");
        require(::posix_spawn_file_actions_adddup2(&files_, standard_input, STDIN_FILENO), "cannot start a worker");
        require(::posix_spawn_file_actions_addopen(&files_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0),
                "cannot start a worker");
        sigset_t none;
        ::sigemptyset(&none);
        ::posix_spawnattr_setsigmask(&attributes_, &none);
        ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK);
    }
    ~SpawnPlan() {
        ::posix_spawnattr_destroy(&attributes_);
        ::posix_spawn_file_actions_destroy(&files_);
    }
    SpawnPlan(const SpawnPlan&) = delete;
    SpawnPlan& operator=(const SpawnPlan&) = delete;

    [[nodiscard]] pid_t start(const std::vector<std::string>& arguments) const {
        std::vector<std::string> words{"lumenline"};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        pid_t process = -1;
        // The very program that runs, whatever has become of its file meanwhile.
        require(::posix_spawn(&process, "/proc/self/exe", &files_, &attributes_, argv.data(), environ),
                "cannot start a worker process");
        return process;
    }

private:
    posix_spawn_file_actions_t files_{};
    posix_spawnattr_t attributes_{};
};

std::array<int, 2> socket_pair() {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
        throw std::system_error(errno, std::generic_category(), "cannot make a channel to a worker process");
    return ends;
}

Channel start(const std::vector<std::string>& arguments, pid_t& process) {
    const std::array<int, 2> ends = socket_pair();
    Channel own(ends[0]);
    const Channel others(ends[1]);
    process = SpawnPlan(others.descriptor()).start(arguments);
    return own;
}

}  // namespace

WorkerProcess::WorkerProcess(const std::vector<std::string>& arguments) : channel_(start(arguments, process_)) {}

WorkerProcess::~WorkerProcess() { kill(); }

int WorkerProcess::wait() {
    int status = 0;
    while (process_ > 0 && ::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
}

void WorkerProcess::kill() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    wait();
}

std::string WorkerNews::message() const {
    std::string message(1, static_cast<char>(kind));
    if (kind == Kind::kStage) message += std::to_string(static_cast<int>(stage));
    if (kind == Kind::kLoaded) message += exact_text(sites) + " ";
    return message + text;
}

WorkerNews WorkerNews::parse(std::string_view message) {
    WorkerNews news;
    if (message.empty()) return news;
    news.kind = static_cast<Kind>(message.front());
    message.remove_prefix(1);
    const char* const end = message.data() + message.size();
    if (news.kind == Kind::kStage) {
        int stage = 0;
        std::from_chars(message.data(), end, stage);
        news.stage = static_cast<Stage>(stage);
    } else if (news.kind == Kind::kLoaded) {
        const char* const space = std::from_chars(message.data(), end, news.sites).ptr;
        if (space != end) news.text.assign(space + 1, end);
    } else {
        news.text = message;
    }
    return news;
}

WorkerLink::WorkerLink() : channel_(STDIN_FILENO) {
    std::signal(SIGINT, SIG_IGN);
    std::signal(SIGTERM, SIG_IGN);
    if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0)
        throw std::system_error(errno, std::generic_category(), "cannot tie a worker to its run");
    // A run that ended before that may have left a request, but has closed its end.
    orphaned_ = !channel_.send(WorkerNews{}.message());
}

}  // namespace lumenline
