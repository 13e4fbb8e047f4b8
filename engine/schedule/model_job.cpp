#include "engine/schedule/model_job.h"

#include <chrono>
#include <new>
#include <utility>

#include "engine/branches/branches.h"
#include "engine/characterize/characterize.h"
#include "engine/condition/condition.h"
#include "engine/core/text.h"
#include "engine/endpoints/endpoints.h"
#include "engine/schedule/memory.h"
#include "engine/trace/trace.h"
#include "engine/voronoi/voronoi.h"

namespace lumenline {

namespace {

Failure describe(Stage stage, const std::exception& thrown) {
    if (const auto* error = dynamic_cast<const StageError*>(&thrown))
        return {error->stage(), error->code(), error->what()};
    if (dynamic_cast<const std::bad_alloc*>(&thrown) != nullptr)
        return {
            stage, ErrorCode::kOutOfMemory,
            "memory ran out in this stage: give the run more memory (run.memory, run.model_memory) or fewer models in "
            "flight"};
    return {stage, ErrorCode::kInternal,
            std::string("internal error, please report it with this model: ") + thrown.what()};
}

}  // namespace

ModelJob::ModelJob(const ModelTask& task, ContextMaker make_context, const std::atomic<bool>* cancelled,
                   ModelLimits limits)
    : task_(task), make_context_(std::move(make_context)), cancelled_(cancelled), limits_(limits) {
    record_.identity = task.identity;
    record_.options = canonical_text(task);
}

void ModelJob::run(Stage stage, Diagnostics& findings, std::optional<Failure>& failure, double& seconds,
                   const std::function<void(StageContext&)>& body) const {
    const auto start = std::chrono::steady_clock::now();
    const std::unique_ptr<StageContext> context =
        make_context_ ? make_context_(stage) : std::make_unique<StageContext>(stage, cancelled_);
    try {
        context->check_cancelled();
        check_limits(stage);
        body(*context);
    } catch (const std::exception& thrown) {
        failure = describe(stage, thrown);
    }
    findings.insert(findings.end(), context->diagnostics().begin(), context->diagnostics().end());
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void ModelJob::run(Stage stage, const std::function<void(StageContext&)>& body) {
    if (failed()) return;
    run(stage, record_.diagnostics, record_.failure, record_.facts.stage_seconds.at(static_cast<std::size_t>(stage)),
        body);
}

void ModelJob::check_limits(Stage stage) const {
    double spent = 0;
    for (const double seconds : record_.facts.stage_seconds) spent += seconds;
    if (limits_.seconds > 0 && spent > limits_.seconds)
        throw StageError(stage, ErrorCode::kTimeout,
                         "the model had taken " + short_text(spent) + " s before this stage, more than its limit of " +
                             short_text(limits_.seconds) + " s (run.model_timeout)");
    const double need = record_.surface ? estimated_memory(static_cast<double>(sites())) : 0;
    constexpr double kMegabyte = 1e6;
    if (limits_.memory > 0 && need > limits_.memory)
        throw StageError(stage, ErrorCode::kOutOfMemory,
                         "a model of " + counted(sites(), "site") + " needs about " + short_text(need / kMegabyte, 3) +
                             " MB, more than its limit of " + short_text(limits_.memory / kMegabyte, 3) +
                             " MB (run.model_memory)");
}

void ModelJob::load(const Loader& loader) {
    run(Stage::kLoad, [&](StageContext&) {
        try {
            soup_ = loader(task_);
        } catch (const SourceError& error) {
            record_.identity.source_sha256 = error.source_sha256();
            throw;
        }
        record_.identity.source_sha256 = soup_.source_sha256;
        record_.diagnostics.insert(record_.diagnostics.end(), soup_.diagnostics.begin(), soup_.diagnostics.end());
    });
}

void ModelJob::condition() {
    run(Stage::kCondition, [&](StageContext& context) {
        ConditionOptions options = task_.options.condition;
        const EndpointModes modes = task_.options.endpoints.mode;
        if (modes.has(EndpointMode::kAuto)) options.flat_caps = FlatCaps::kOpenIfClosed;
        if (modes.has(EndpointMode::kCaps)) options.flat_caps = FlatCaps::kOpen;
        record_.surface = std::make_shared<const Surface>(condition_surface(soup_, options, context));
    });
    soup_ = {};
}

void ModelJob::build_complex() {
    run(Stage::kVoronoi, [&](StageContext& context) {
        record_.complex =
            std::make_shared<const VoronoiComplex>(build_voronoi(*record_.surface, task_.options.voronoi, context));
    });
}

void ModelJob::find_endpoints() {
    run(Stage::kEndpoints, [&](StageContext& context) {
        record_.endpoints = std::make_shared<const Endpoints>(
            lumenline::find_endpoints(*record_.surface, *record_.complex, task_.options.endpoints, context));
        for (std::size_t i = 0; i < record_.endpoints->size(); ++i)
            if ((*record_.endpoints)[i].role == EndpointRole::kInlet)
                sources_.push_back({EndpointId(i), {}, {}, {}, 0});
    });
    sources_left_ = sources_.size();
}

void ModelJob::solve(std::size_t source, EikonalWorkspace& work) {
    Source& s = sources_[source];
    run(Stage::kEikonal, s.diagnostics, s.failure, s.seconds, [&](StageContext& context) {
        ArrivalField field = solve_eikonal(*record_.complex, (*record_.endpoints)[at(s.endpoint)].seeds, work, context);
        field.source = s.endpoint;
        s.field = std::make_shared<const ArrivalField>(std::move(field));
    });
}

void ModelJob::join_sources() {
    for (Source& s : sources_) {
        record_.facts.stage_seconds.at(static_cast<std::size_t>(Stage::kEikonal)) += s.seconds;
        record_.diagnostics.insert(record_.diagnostics.end(), s.diagnostics.begin(), s.diagnostics.end());
        if (s.failure && !record_.failure) record_.failure = s.failure;
        if (s.field) record_.fields.push_back(s.field);
    }
}

void ModelJob::trace() {
    if (failed()) return;
    join_sources();
    run(Stage::kTrace, [&](StageContext& context) {
        record_.centerlines = std::make_shared<const Centerlines>(trace_centerlines(
            *record_.surface, *record_.complex, *record_.endpoints, record_.fields, task_.options.trace, context));
    });
}

void ModelJob::characterize() {
    if (!task_.options.characterize) return;
    run(Stage::kCharacterize, [&](StageContext& context) {
        record_.character = std::make_shared<const SurfaceCharacter>(characterize_surface(
            *record_.surface, *record_.complex, *record_.endpoints, *record_.centerlines, context));
    });
}

void ModelJob::find_branches() {
    if (!task_.options.branches.enabled) return;
    run(Stage::kBranches, [&](StageContext& context) {
        record_.branches = std::make_shared<const Branches>(
            lumenline::find_branches(*record_.surface, *record_.centerlines, record_.character.get(),
                                     task_.options.branches, context));
    });
}

ModelRecord ModelJob::take() {
    record_.status = ModelStatus::kOk;
    for (const Diagnostic& d : record_.diagnostics)
        if (d.severity != Severity::kNote) record_.status = ModelStatus::kWarning;
    if (record_.failure) record_.status = ModelStatus::kFailed;
    for (const double s : record_.facts.stage_seconds) record_.facts.total_seconds += s;
    return std::move(record_);
}

ModelRecord process_model(const ModelTask& task, const Loader& loader) {
    ModelJob job(task, nullptr, nullptr);
    EikonalWorkspace work;
    job.load(loader);
    job.condition();
    job.build_complex();
    job.find_endpoints();
    for (std::size_t i = 0; i < job.source_count(); ++i) job.solve(i, work);
    job.trace();
    job.characterize();
    job.find_branches();
    return job.take();
}

}  // namespace lumenline
