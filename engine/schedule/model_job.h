#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "engine/core/model_record.h"
#include "engine/core/options.h"
#include "engine/core/soup.h"
#include "engine/core/stage_context.h"
#include "engine/eikonal/eikonal.h"

namespace lumenline {

/// Reads the surface of a task, scaled by its `scale`. Called from several threads at once.
using Loader = std::function<TriangleSoup(const ModelTask&)>;

/// What one model may take. Looked at as each stage begins.
struct ModelLimits {
    double seconds = 0;  ///< work after which no further stage begins; 0 = none
    double memory = 0;   ///< estimated need, as soon as its sites are known [bytes]; 0 = none
};

/// One model on its way through the stages. Every call catches what its stage throws and turns it
/// into the record's failure; later calls then do nothing. No two calls on one job may run at once,
/// but for solve() with different sources.
class ModelJob {
public:
    /// How a stage gets its surroundings; null = serial.
    using ContextMaker = std::function<std::unique_ptr<StageContext>(Stage)>;

    ModelJob(const ModelTask& task, ContextMaker make_context, const std::atomic<bool>* cancelled,
             ModelLimits limits = {});

    void load(const Loader& loader);
    void condition();
    void build_complex();
    void find_endpoints();
    [[nodiscard]] std::size_t source_count() const { return sources_.size(); }
    void solve(std::size_t source, EikonalWorkspace& work);
    /// True for exactly one call: that of the source solved last.
    bool last_source_done() { return sources_left_.fetch_sub(1) == 1; }
    void trace();
    void characterize();
    void find_branches();

    /// Of the surface as far as it has come; 0 = it has not been read.
    [[nodiscard]] std::size_t sites() const {
        return record_.surface ? record_.surface->site_count() : soup_.points.size();
    }
    [[nodiscard]] bool failed() const { return record_.failure.has_value(); }
    /// Was the run stopped before this model was done?
    [[nodiscard]] bool interrupted() const { return failed() && record_.failure->code == ErrorCode::kInterrupted; }
    /// The finished record; the job is spent.
    ModelRecord take();

private:
    struct Source {
        EndpointId endpoint;
        std::shared_ptr<const ArrivalField> field;
        Diagnostics diagnostics;
        std::optional<Failure> failure;
        double seconds = 0;
    };

    /// Runs one stage: its time, its findings, its failure.
    void run(Stage stage, Diagnostics& findings, std::optional<Failure>& failure, double& seconds,
             const std::function<void(StageContext&)>& body) const;
    void run(Stage stage, const std::function<void(StageContext&)>& body);
    /// Throws StageError kTimeout or kOutOfMemory if the model is beyond its limits.
    void check_limits(Stage stage) const;
    /// Gathers the solved sources in endpoint order.
    void join_sources();

    const ModelTask& task_;
    ContextMaker make_context_;
    const std::atomic<bool>* cancelled_;
    ModelLimits limits_;
    ModelRecord record_;
    TriangleSoup soup_;
    std::vector<Source> sources_;
    std::atomic<std::size_t> sources_left_{0};
};

/// All stages of one model, one after the other in the calling thread.
ModelRecord process_model(const ModelTask& task, const Loader& loader);

}  // namespace lumenline
