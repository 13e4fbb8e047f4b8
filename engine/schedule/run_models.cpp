// The graph:
//
//   admission -> load -> condition -> voronoi -> endpoints -> fan out --> eikonal (per source) --> trace
//       ^                                                        \__ failed: no sources ____________/ |
//       |_________________________ release: writer <- characterize <---------------------------------|
//
// Admission is a serial node that holds the queue and what is free of places and memory: each model that leaves
// gives back what it took, so no token can be lost between a failure and its release. The sources of a model count
// down; the last one sends it on. Bodies never throw: an exception that leaves a node cancels the graph, and with it
// every other model. The graph is built inside its arena, or it would run on one thread.
#include "engine/schedule/run_models.h"

#include <sys/resource.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/flow_graph.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <iterator>
#include <limits>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "engine/schedule/handover.h"

namespace lumenline {

namespace {

namespace flow = tbb::flow;

/// A model in flight, and what it took from the budget.
struct AdmittedJob : ModelJob {
    using ModelJob::ModelJob;
    double bytes = 0;
};

/// What becomes free.
struct Release {
    int places = 0;
    double bytes = 0;
    int models = 0;  ///< that have left
};

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

double peak_resident_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1024;
}

class CohortGraph {
public:
    CohortGraph(std::span<const ModelTask> tasks, const ScheduleOptions& options, const Loader& loader,
                const Sink& sink, RunReport& report)
        : tasks_(tasks),
          cancelled_(options.cancelled),
          memory_(options.memory > 0 ? options.memory : std::numeric_limits<double>::infinity()),
          memory_of_(options.memory_of),
          timeout_(options.model_timeout),
          loader_(loader),
          sink_(sink),
          report_(report),
          admission_(graph_, flow::serial, [this](const Release& r, auto& ports) { admit(r, ports); }),
          load_(graph_, flow::unlimited, [this](const JobPtr& job) { return step(job, [&] { job->load(loader_); }); }),
          condition_(graph_, flow::unlimited, [](const JobPtr& job) { return step(job, [&] { job->condition(); }); }),
          voronoi_(graph_, flow::unlimited, [](const JobPtr& job) { return step(job, [&] { job->build_complex(); }); }),
          endpoints_(graph_, flow::unlimited,
                     [](const JobPtr& job) { return step(job, [&] { job->find_endpoints(); }); }),
          fan_out_(graph_, flow::unlimited, [](const JobPtr& job, auto& ports) { fan_out(job, ports); }),
          eikonal_(graph_, flow::unlimited, [this](const SourceOfJob& source, auto& ports) { solve(source, ports); }),
          trace_(graph_, flow::unlimited, [](const JobPtr& job) { return step(job, [&] { job->trace(); }); }),
          characterize_(graph_, flow::unlimited,
                        [](const JobPtr& job) { return step(job, [&] { job->characterize(); }); }),
          writer_(graph_, flow::serial, [this](const JobPtr& job) { return write(*job); }) {
        flow::make_edge(flow::output_port<0>(admission_), load_);
        flow::make_edge(load_, condition_);
        flow::make_edge(condition_, voronoi_);
        flow::make_edge(voronoi_, endpoints_);
        flow::make_edge(endpoints_, fan_out_);
        flow::make_edge(flow::output_port<0>(fan_out_), eikonal_);
        flow::make_edge(flow::output_port<1>(fan_out_), trace_);
        flow::make_edge(flow::output_port<0>(eikonal_), trace_);
        flow::make_edge(trace_, characterize_);
        flow::make_edge(characterize_, writer_);
        flow::make_edge(writer_, admission_);
    }

    void run(int in_flight) {
        queue_.reserve(tasks_.size());
        for (std::size_t i = tasks_.size(); i-- > 0;) queue_.push_back({i, memory_of_ ? memory_of_(tasks_[i]) : 0});
        most_passed_ = in_flight;
        handed_on(this);
        admission_.try_put({in_flight, memory_, 0});
        graph_.wait_for_all();
        taken(this);
        report_.not_started = queue_.size();
        if (sink_failure_) std::rethrow_exception(sink_failure_);
        const std::size_t known =
            report_.ok + report_.warning + report_.failed + report_.interrupted + report_.not_started;
        if (known != tasks_.size())
            throw std::logic_error("internal error: a model was lost on its way through the graph");
    }

private:
    using Admission = flow::multifunction_node<Release, std::tuple<JobPtr>>;
    using FanOut = flow::multifunction_node<JobPtr, std::tuple<SourceOfJob, JobPtr>>;
    using Solver = flow::multifunction_node<SourceOfJob, std::tuple<JobPtr>>;
    using StageNode = flow::function_node<JobPtr, JobPtr>;

    [[nodiscard]] bool stopped() const { return sink_failed_ || (cancelled_ != nullptr && cancelled_->load()); }

    /// One stage of a job, and the job again.
    template <class Body>
    static JobPtr step(const JobPtr& job, const Body& body) {
        const Handover scope(job.get());
        body();
        return job;
    }

    struct Waiting {
        std::size_t task;
        double bytes;
    };

    /// Lets in as many models as there is room for.
    void admit(const Release& release, Admission::output_ports_type& ports) {
        const Handover scope(this);
        places_ += release.places;
        bytes_ += release.bytes;
        in_flight_ -= release.models;
        while (places_ > 0 && !stopped()) {
            const auto chosen = next_that_fits();
            if (chosen == queue_.rend()) return;
            const auto context = [this](Stage stage) { return std::make_unique<ParallelContext>(stage, cancelled_); };
            const auto job = std::make_shared<AdmittedJob>(tasks_[chosen->task], context, cancelled_, timeout_);
            job->bytes = chosen->bytes;
            --places_;
            bytes_ -= job->bytes;
            ++in_flight_;
            queue_.erase(std::next(chosen).base());
            handed_on(job.get());
            std::get<0>(ports).try_put(job);
        }
    }

    /// The queue is in reverse: what is taken from it mostly stands at its end.
    std::vector<Waiting>::reverse_iterator next_that_fits() {
        const auto first = queue_.rbegin();
        if (first == queue_.rend()) return first;
        if (in_flight_ == 0 || first->bytes <= bytes_) {
            passed_ = 0;
            return first;
        }
        if (passed_ >= most_passed_) return queue_.rend();
        const auto found = std::find_if(first, queue_.rend(), [this](const Waiting& w) { return w.bytes <= bytes_; });
        if (found != queue_.rend()) ++passed_;
        return found;
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

    /// Hands the record on and frees its place.
    Release write(AdmittedJob& job) {
        taken(&job);
        const Handover scope(this);
        const Release release{1, job.bytes, 1};
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
    const std::atomic<bool>* cancelled_;
    double memory_;
    const std::function<double(const ModelTask&)>& memory_of_;
    double timeout_;
    const Loader& loader_;
    const Sink& sink_;
    RunReport& report_;
    std::vector<Waiting> queue_;
    int places_ = 0, in_flight_ = 0, passed_ = 0, most_passed_ = 0;  // of the admission
    double bytes_ = 0;
    std::exception_ptr sink_failure_;
    std::atomic<bool> sink_failed_{false};
    tbb::enumerable_thread_specific<EikonalWorkspace> workspaces_;
    flow::graph graph_;
    Admission admission_;
    StageNode load_, condition_, voronoi_, endpoints_;
    FanOut fan_out_;
    Solver eikonal_;
    StageNode trace_, characterize_;
    flow::function_node<JobPtr, Release> writer_;
};

}  // namespace

int available_threads() { return tbb::info::default_concurrency(); }

RunReport run_models(std::span<const ModelTask> tasks, const ScheduleOptions& options, const Loader& loader,
                     const Sink& sink) {
    const auto start = std::chrono::steady_clock::now();
    RunReport report;
    report.threads = options.threads > 0 ? options.threads : available_threads();
    const int in_flight = options.models_in_flight > 0 ? options.models_in_flight : 2 * report.threads + 1;
    tbb::task_arena arena(report.threads);
    arena.execute([&] {
        CohortGraph graph(tasks, options, loader, sink, report);
        graph.run(in_flight);
    });
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
}

}  // namespace lumenline
