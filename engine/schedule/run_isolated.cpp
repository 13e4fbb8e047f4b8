// One thread, which waits for news of the workers and for the clock. oneTBB has no part in it: it computes in the
// workers. A model that is being written has no use for a core, so the next one is begun beside it; that takes one more
// worker, which stays for later models.

#include "engine/schedule/run_isolated.h"

#include <poll.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "engine/core/text.h"
#include "engine/schedule/admission.h"
#include "engine/schedule/worker.h"

namespace lumenline {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// A worker and the model it has.
struct Seat {
    std::unique_ptr<WorkerProcess> worker;
    bool ready = false;  ///< the worker has said so
    const ModelTask* task = nullptr;
    Stage stage = Stage::kLoad;
    bool has_place = false;
    double bytes = 0;
    Clock::time_point since;
    std::string source_sha256;
};

Failure death(const Seat& seat, int status) {
    const std::string where = ", in this stage: report it with the model";
    if (!WIFSIGNALED(status))
        return {seat.stage, ErrorCode::kCrashed,
                "the worker process of this model ended with status " + std::to_string(WEXITSTATUS(status)) + where};
    const int signal = WTERMSIG(status);
    const char* const name = ::sigabbrev_np(signal);
    const std::string ended = "the worker process of this model was ended by signal " + std::to_string(signal) +
                              (name == nullptr ? "" : std::string(" (SIG") + name + ")");
    if (signal == SIGKILL)
        return {seat.stage, ErrorCode::kCrashed,
                ended + ", in this stage, as the system does when memory runs out: give the run more memory", signal};
    return {seat.stage, ErrorCode::kCrashed, ended + where, signal};
}

class IsolatedRun {
public:
    IsolatedRun(std::span<const ModelTask> tasks, const ScheduleOptions& options, const IsolatedHandlers& handlers,
                int threads, RunReport& report)
        : tasks_(tasks),
          options_(options),
          handlers_(handlers),
          threads_(threads),
          report_(report),
          queue_(needs_of(tasks, options), places_of(options, threads), options.memory) {}

    void run() {
        while (!stopped()) {
            admit();
            if (std::ranges::none_of(seats_, [](const Seat& seat) { return seat.task != nullptr; })) break;
            wait();
            for (Seat& seat : seats_) attend(seat);
        }
        for (Seat& seat : seats_) attend(seat);  // what was done while we looked away
        for (const Seat& seat : seats_) report_.interrupted += seat.task != nullptr ? 1 : 0;
        report_.not_started = queue_.waiting();
        seats_.clear();
    }

private:
    static int places_of(const ScheduleOptions& options, int threads) {
        return options.models_in_flight > 0 ? std::min(options.models_in_flight, threads) : threads;
    }

    [[nodiscard]] bool stopped() const { return options_.cancelled != nullptr && options_.cancelled->load(); }

    void admit() {
        while (const auto admitted = queue_.next()) {
            Seat& seat = free_seat();
            seat.task = &tasks_[admitted->model];
            seat.stage = Stage::kLoad;
            seat.has_place = true;
            seat.bytes = admitted->bytes;
            seat.since = Clock::now();
            seat.source_sha256.clear();
            const std::string request = handlers_.request(*seat.task, threads_for_next());
            if (seat.worker->channel().send(request)) continue;
            // It died while it had nothing to do.
            start_worker(seat);
            seat.worker->channel().send(request);
        }
    }

    Seat& free_seat() {
        const auto free = std::ranges::find(seats_, nullptr, &Seat::task);
        if (free != seats_.end() && free->worker) return *free;
        Seat& seat = free != seats_.end() ? *free : seats_.emplace_back();
        start_worker(seat);
        return seat;
    }

    void start_worker(Seat& seat) const {
        seat.worker = std::make_unique<WorkerProcess>(handlers_.worker);
        seat.ready = false;
    }

    /// Threads of a model that has just been given a place: its share, if few others compute or could.
    [[nodiscard]] int threads_for_next() const {
        const auto all = static_cast<std::size_t>(threads_);
        const auto computing = static_cast<std::size_t>(std::ranges::count(seats_, true, &Seat::has_place));
        const std::size_t together = std::min(all, computing + queue_.would_fit(all));
        return static_cast<int>(std::max<std::size_t>(all / std::max<std::size_t>(together, 1), 1));
    }

    /// Until there is news, for a tenth of a second at most: the clock and the signals are looked at as often.
    void wait() {
        constexpr int kMilliseconds = 100;
        std::vector<pollfd> channels;
        for (Seat& seat : seats_)
            if (seat.worker) channels.push_back({seat.worker->channel().descriptor(), POLLIN, 0});
        ::poll(channels.data(), channels.size(), kMilliseconds);
    }

    void attend(Seat& seat) {
        if (!seat.worker) return;
        std::vector<std::string> messages;
        const bool alive = seat.worker->channel().take_arrived(messages);
        for (const std::string& message : messages) hear(seat, WorkerNews::parse(message));
        if (!alive) {
            mourn(seat);
        } else if (seat.task != nullptr && options_.model_timeout > 0 &&
                   seconds_since(seat.since) > options_.model_timeout) {
            seat.worker.reset();
            finish(seat,
                   {"", Failure{seat.stage, ErrorCode::kTimeout,
                                "the model had taken " + short_text(seconds_since(seat.since)) +
                                    " s in this stage, more than its limit of " + short_text(options_.model_timeout) +
                                    " s (run.model_timeout), and its process was ended"}});
        }
    }

    void hear(Seat& seat, const WorkerNews& news) {
        if (news.kind == WorkerNews::Kind::kReady) seat.ready = true;
        if (seat.task == nullptr) return;
        if (news.kind == WorkerNews::Kind::kStage) {
            seat.stage = news.stage;
            if (seat.stage == Stage::kArchive) give_back_place(seat);
        } else if (news.kind == WorkerNews::Kind::kLoaded) {
            seat.source_sha256 = news.text;
            if (!options_.refined_memory_of) return;
            const double bytes = options_.refined_memory_of(news.sites);
            queue_.correct(bytes - seat.bytes);
            seat.bytes = bytes;
        } else if (news.kind == WorkerNews::Kind::kDone) {
            finish(seat, {news.text, std::nullopt});
        }
    }

    void give_back_place(Seat& seat) {
        if (seat.has_place) queue_.free_place();
        seat.has_place = false;
    }

    /// The worker is dead.
    void mourn(Seat& seat) {
        const int status = seat.worker->wait();
        seat.worker.reset();
        if (!seat.ready)
            throw std::runtime_error("worker processes cannot be run: one ended at once, with status " +
                                     std::to_string(WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status)));
        if (seat.task != nullptr) finish(seat, {"", death(seat, status)});
    }

    void finish(Seat& seat, IsolatedResult result) {
        result.source_sha256 = seat.source_sha256;
        result.seconds = seconds_since(seat.since);
        give_back_place(seat);
        queue_.leave(seat.bytes);
        const ModelTask& task = *std::exchange(seat.task, nullptr);
        const ModelStatus status = handlers_.done(task, std::move(result));
        ++(status == ModelStatus::kOk        ? report_.ok
           : status == ModelStatus::kWarning ? report_.warning
                                             : report_.failed);
    }

    std::span<const ModelTask> tasks_;
    const ScheduleOptions& options_;
    const IsolatedHandlers& handlers_;
    int threads_;
    RunReport& report_;
    Admission queue_;
    std::vector<Seat> seats_;
};

}  // namespace

RunReport run_isolated(std::span<const ModelTask> tasks, const ScheduleOptions& options,
                       const IsolatedHandlers& handlers) {
    const auto start = Clock::now();
    RunReport report;
    report.threads = options.threads > 0 ? options.threads : available_threads();
    IsolatedRun(tasks, options, handlers, report.threads, report).run();
    report.seconds = seconds_since(start);
    return report;
}

}  // namespace lumenline
