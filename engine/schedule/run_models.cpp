// The graph:
//
//   admission -> load -> condition -> voronoi -> endpoints -> fan out --> eikonal (per source) --> trace
//       ^                                                        \__ failed: no sources ____________/ |
//       |_________________________ release: writer <- branches <- characterize <----------------------|
//
// Admission is a serial node: each model that leaves gives back what it took, so no token can be lost between a
// failure and its release; and when its surface is read, and again when it is conditioned, what the model takes is put
// right. What it sends to `load` says only that there is work, which is then taken from a queue in the order of
// admission: a thread runs its newest task first, and a large model admitted early would otherwise be begun last. The
// sources of a model count down; the last one sends it on. The writer is a thread outside the arena, because it waits
// for the disk: a thread of the arena would be a core with nothing to do meanwhile. Bodies never throw: an exception
// that leaves a node cancels the graph, and with it every other model. The graph is built inside its arena, or it would
// run on one thread.
#include "engine/schedule/run_models.h"

#include <tbb/concurrent_queue.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/flow_graph.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/schedule/admission.h"
#include "engine/schedule/handover.h"
#include "engine/schedule/memory.h"

namespace lumenline {

namespace {

namespace flow = tbb::flow;

/// A model in flight, and what it took from the budget.
struct AdmittedJob : ModelJob {
    using ModelJob::ModelJob;
    double bytes = 0;
};

/// News for the admission.
struct Release {
    bool left = false;  ///< a model has
    double bytes = 0;   ///< that become free
};

/// One more admitted model is to be loaded.
struct Begin {};

using JobPtr = std::shared_ptr<AdmittedJob>;
using SourceOfJob = std::pair<JobPtr, std::size_t>;

/// Stage surroundings whose loops run on the arena's threads. Waiting for a loop takes no other work:
/// a stage must not find itself inside another model's.
class ParallelContext : public StageContext {
public:
    using StageContext::StageContext;

    void parallel_for(std::size_t count, std::size_t grain,
                      const std::function<void(std::size_t, std::size_t)>& body) const override {
        const std::size_t chunks = (count + grain - 1) / grain;
        tbb::this_task_arena::isolate([&] {
            handed_on(&count);
            tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
                taken(&count);
                check_cancelled();
                body(chunk * grain, std::min((chunk + 1) * grain, count));
                handed_on(&chunks);
            });
            taken(&chunks);
        });
    }
};

class CohortGraph {
public:
    CohortGraph(std::span<const ModelTask> tasks, const ScheduleOptions& options, int in_flight, const Loader& loader,
                const Sink& sink, RunReport& report)
        : tasks_(tasks),
          options_(options),
          loader_(loader),
          sink_(sink),
          report_(report),
          queue_(needs_of(tasks, options), in_flight, options.memory),
          admission_(graph_, flow::serial, [this](const Release& r, auto& ports) { admit(r, ports); }),
          load_(graph_, flow::unlimited, [this](const Begin&) { return load_next(); }),
          condition_(graph_, flow::unlimited,
                     [this](const JobPtr& job) { return step(job, [&] { condition(*job); }); }),
          voronoi_(graph_, flow::unlimited, [](const JobPtr& job) { return step(job, [&] { job->build_complex(); }); }),
          endpoints_(graph_, flow::unlimited,
                     [](const JobPtr& job) { return step(job, [&] { job->find_endpoints(); }); }),
          fan_out_(graph_, flow::unlimited, [](const JobPtr& job, auto& ports) { fan_out(job, ports); }),
          eikonal_(graph_, flow::unlimited, [this](const SourceOfJob& source, auto& ports) { solve(source, ports); }),
          trace_(graph_, flow::unlimited, [](const JobPtr& job) { return step(job, [&] { job->trace(); }); }),
          characterize_(graph_, flow::unlimited,
                        [](const JobPtr& job) { return step(job, [&] { job->characterize(); }); }),
          branches_(graph_, flow::unlimited,
                    [](const JobPtr& job) { return step(job, [&] { job->find_branches(); }); }),
          writer_(graph_, flow::unlimited,
                  [this](const JobPtr& job, WriterNode::gateway_type& gateway) { hand_to_writer(job, gateway); }),
          writing_thread_([this](const std::stop_token& stop) { write_all(stop); }) {
        flow::make_edge(flow::output_port<0>(admission_), load_);
        flow::make_edge(load_, condition_);
        flow::make_edge(condition_, voronoi_);
        flow::make_edge(voronoi_, endpoints_);
        flow::make_edge(endpoints_, fan_out_);
        flow::make_edge(flow::output_port<0>(fan_out_), eikonal_);
        flow::make_edge(flow::output_port<1>(fan_out_), trace_);
        flow::make_edge(flow::output_port<0>(eikonal_), trace_);
        flow::make_edge(trace_, characterize_);
        flow::make_edge(characterize_, branches_);
        flow::make_edge(branches_, writer_);
        flow::make_edge(writer_, admission_);
    }

    void run() {
        handed_on(this);
        admission_.try_put({});
        graph_.wait_for_all();
        taken(this);
        report_.not_started = queue_.waiting();
        if (sink_failure_) std::rethrow_exception(sink_failure_);
        const std::size_t known =
            report_.ok + report_.warning + report_.failed + report_.interrupted + report_.not_started;
        if (known != tasks_.size())
            throw std::logic_error("internal error: a model was lost on its way through the graph");
    }

private:
    using AdmissionNode = flow::multifunction_node<Release, std::tuple<Begin>>;
    using FanOut = flow::multifunction_node<JobPtr, std::tuple<SourceOfJob, JobPtr>>;
    using Solver = flow::multifunction_node<SourceOfJob, std::tuple<JobPtr>>;
    using StageNode = flow::function_node<JobPtr, JobPtr>;
    using WriterNode = flow::async_node<JobPtr, Release>;

    [[nodiscard]] bool stopped() const {
        return sink_failed_ || (options_.cancelled != nullptr && options_.cancelled->load());
    }

    /// One stage of a job, and the job again.
    template <class Body>
    static JobPtr step(const JobPtr& job, const Body& body) {
        const Handover scope(job.get());
        body();
        return job;
    }

    /// Lets in as many models as there is room for.
    void admit(const Release& release, AdmissionNode::output_ports_type& ports) {
        const Handover scope(this);
        if (release.left) {
            queue_.free_place();
            queue_.leave(release.bytes);
        } else {
            queue_.correct(-release.bytes);
        }
        while (!stopped()) {
            const auto admitted = queue_.next();
            if (!admitted) return;
            const ModelTask& task = tasks_[admitted->model];
            const auto context = [this, &task](Stage stage) {
                if (options_.on_stage) options_.on_stage(task, stage);
                return std::make_unique<ParallelContext>(stage, options_.cancelled);
            };
            const auto job = std::make_shared<AdmittedJob>(task, context, options_.cancelled,
                                                           ModelLimits{options_.model_timeout, options_.model_memory});
            job->bytes = admitted->bytes;
            handed_on(job.get());
            admitted_.push(job);
            std::get<0>(ports).try_put({});
        }
    }

    /// Loads the model that was admitted first.
    JobPtr load_next() {
        JobPtr job;
        if (!admitted_.try_pop(job)) throw std::logic_error("internal error: more models are begun than are admitted");
        return step(job, [&] {
            job->load(loader_);
            correct_memory(*job);
        });
    }

    void condition(AdmittedJob& job) {
        job.condition();
        correct_memory(job);
    }

    /// What a model takes from the budget, now that more is known of it.
    void correct_memory(AdmittedJob& job) {
        if (!options_.refined_memory_of || job.sites() == 0) return;
        const double bytes = options_.refined_memory_of(static_cast<double>(job.sites()));
        const double freed = std::exchange(job.bytes, bytes) - bytes;
        if (freed != 0) admission_.try_put({false, freed});
    }

    static void fan_out(const JobPtr& job, FanOut::output_ports_type& ports) {
        taken(job.get());
        if (job->failed()) {
            std::get<1>(ports).try_put(job);
            return;
        }
        for (std::size_t i = 0, n = job->source_count(); i < n; ++i) std::get<0>(ports).try_put({job, i});
    }

    void solve(const SourceOfJob& source, Solver::output_ports_type& ports) {
        {
            const Handover scope(source.first.get());
            source.first->solve(source.second, workspaces_.local());
        }
        if (source.first->last_source_done()) std::get<0>(ports).try_put(source.first);
    }

    struct ToWrite {
        JobPtr job;
        WriterNode::gateway_type* gateway;
    };

    void hand_to_writer(const JobPtr& job, WriterNode::gateway_type& gateway) {
        gateway.reserve_wait();
        {
            const std::lock_guard lock(writing_);
            to_write_.push_back({job, &gateway});
        }
        to_write_more_.notify_one();
    }

    /// Of the writer's thread.
    void write_all(const std::stop_token& stop) {
        std::unique_lock lock(writing_);
        while (to_write_more_.wait(lock, stop, [this] { return !to_write_.empty(); })) {
            ToWrite next = std::move(to_write_.front());
            to_write_.pop_front();
            lock.unlock();
            const Release release = write(*next.job);
            next.job.reset();
            next.gateway->try_put(release);
            next.gateway->release_wait();
            lock.lock();
        }
    }

    /// Hands the record on.
    Release write(AdmittedJob& job) {
        taken(&job);
        const Handover scope(this);
        const Release release{true, job.bytes};
        const bool interrupted = job.interrupted();
        ModelRecord record = job.take();
        record.facts.peak_resident_bytes = peak_resident_bytes();
        record.facts.threads = report_.threads;
        if (interrupted) {
            ++report_.interrupted;
            return release;
        }
        ++(record.status == ModelStatus::kOk        ? report_.ok
           : record.status == ModelStatus::kWarning ? report_.warning
                                                    : report_.failed);
        if (sink_failed_) return release;
        try {
            sink_(std::move(record));
        } catch (...) {
            sink_failure_ = std::current_exception();
            sink_failed_ = true;
        }
        return release;
    }

    std::span<const ModelTask> tasks_;
    const ScheduleOptions& options_;
    const Loader& loader_;
    const Sink& sink_;
    RunReport& report_;
    Admission queue_;  // of the admission's node
    tbb::concurrent_queue<JobPtr> admitted_;
    std::exception_ptr sink_failure_;
    std::atomic<bool> sink_failed_{false};
    tbb::enumerable_thread_specific<EikonalWorkspace> workspaces_;
    flow::graph graph_;
    AdmissionNode admission_;
    flow::function_node<Begin, JobPtr> load_;
    StageNode condition_, voronoi_, endpoints_;
    FanOut fan_out_;
    Solver eikonal_;
    StageNode trace_, characterize_, branches_;
    WriterNode writer_;

    std::mutex writing_;  // of the queue
    std::condition_variable_any to_write_more_;
    std::deque<ToWrite> to_write_;
    std::jthread writing_thread_;  // last: it is joined before the others go
};

}  // namespace

std::vector<double> needs_of(std::span<const ModelTask> tasks, const ScheduleOptions& options) {
    std::vector<double> needs;
    needs.reserve(tasks.size());
    for (const ModelTask& task : tasks) needs.push_back(options.memory_of ? options.memory_of(task) : 0);
    return needs;
}

int available_threads() { return tbb::info::default_concurrency(); }

RunReport run_models(std::span<const ModelTask> tasks, const ScheduleOptions& options, const Loader& loader,
                     const Sink& sink) {
    const auto start = std::chrono::steady_clock::now();
    RunReport report;
    report.threads = options.threads > 0 ? options.threads : available_threads();
    const int in_flight = options.models_in_flight > 0 ? options.models_in_flight : 2 * report.threads + 1;
    tbb::task_arena arena(report.threads);
    arena.execute([&] {
        CohortGraph graph(tasks, options, in_flight, loader, sink, report);
        graph.run();
    });
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
}

}  // namespace lumenline
