// The two ends of a model's way through a worker. The worker writes the model's file itself, by the same means as a run
// does: a record is many times larger than what has to be known of it here, and the bytes are the same whoever writes
// them. The run holds the lease for its workers, since they end with it.
//
// A request is texts with a NUL between them, because paths may hold anything else; last the resolved configuration of
// this one model. What determines the result goes beside it in canonical form, to be compared.

#include "engine/cli/isolated.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <limits>
#include <memory>
#include <stdexcept>

#include "engine/cli/model_io.h"
#include "engine/cli/plan.h"
#include "engine/cli/run.h"
#include "engine/cli/store.h"
#include "engine/schedule/memory.h"
#include "engine/schedule/worker.h"
#include "io/archive/model_file.h"
#include "io/mesh/sha256.h"

namespace lumenline {

namespace {

struct Request {
    int threads = 1;
    CohortConfig config;  ///< of one model
};

Request parse_request(const std::string& message) {
    constexpr std::size_t kTexts = 7;
    std::array<std::string, kTexts> texts;
    std::size_t from = 0;
    for (std::size_t i = 0; i < kTexts; ++i) {
        const std::size_t to = i + 1 == kTexts ? message.size() : message.find('\0', from);
        if (to == std::string::npos) throw std::logic_error("a request to a worker is incomplete");
        texts[i] = message.substr(from, to - from);
        from = to + 1;
    }
    Request request{std::stoi(texts[0]), parse_cohort(texts[6], texts[1])};
    request.config.archive.directory = texts[2];
    ModelTask& task = request.config.tasks.at(0);
    task.surface_path = texts[3];
    task.identity.source_file = texts[4];
    if (canonical_text(task) != texts[5])
        throw std::logic_error("a worker understands its model otherwise than its run");
    return request;
}

/// Computes a model and stores it. @returns what `settle` reads
std::string serve(const std::string& message, WorkerLink& link) {
    const Request request = parse_request(message);
    forget_peak();
    ScheduleOptions schedule;
    schedule.threads = request.threads;
    schedule.on_stage = [&](const ModelTask&, Stage stage) { link.tell({WorkerNews::Kind::kStage, stage}); };
    const Loader loader = [&](const ModelTask& task) {
        TriangleSoup soup = load_task(task);
        link.tell(
            {WorkerNews::Kind::kLoaded, Stage::kLoad, static_cast<double>(soup.points.size()), soup.source_sha256});
        return soup;
    };
    std::string reply;
    run_models(request.config.tasks, schedule, loader, [&](ModelRecord&& record) {
        link.tell({WorkerNews::Kind::kStage, Stage::kArchive});
        const StoredModel stored = store_model(std::move(record), request.config.tasks.front(), request.config.archive);
        if (stored.written) return;
        const Failure& failure = *stored.summary.failure;
        reply =
            fmt::format("{} {} {}", static_cast<int>(failure.stage), static_cast<int>(failure.code), failure.sentence);
    });
    give_back_free_memory();
    return reply;
}

Failure parse_failure(const std::string& reply) {
    Failure failure;
    std::size_t code = 0, sentence = 0;
    failure.stage = static_cast<Stage>(std::stoi(reply, &code));
    failure.code = static_cast<ErrorCode>(std::stoi(reply.substr(code), &sentence));
    failure.sentence = reply.substr(code + sentence + 1);
    return failure;
}

int work(double memory) {
    WorkerLink link;
    if (memory > 0) limit_memory(memory);
    while (const auto request = link.next_request()) link.tell({WorkerNews::Kind::kDone, {}, 0, serve(*request, link)});
    return kDone;
}

}  // namespace

std::vector<std::string> worker_arguments(const RunOptions& run) {
    return {"worker", "--memory", fmt::format("{:.0f}", run.model_memory)};
}

std::string worker_request(const CohortConfig& config, const ModelTask& task, int threads) {
    CohortConfig one;
    one.name = config.name;
    one.file = config.file;
    one.run = config.run;
    one.archive = config.archive;
    one.tasks = {task};
    std::string message;
    for (const std::string& text : {std::to_string(threads), config.file.string(), config.archive.directory.string(),
                                    task.surface_path, task.identity.source_file, canonical_text(task)})
        message.append(text).push_back('\0');
    return message + resolved_text(one);
}

ModelSummary settle(const IsolatedResult& result, const ModelTask& task, const ArchiveSettings& archive) {
    if (result.failure) {
        ModelRecord record;
        record.identity = task.identity;
        record.identity.source_sha256 =
            result.source_sha256.empty() ? sha256_of_file(task.surface_path) : result.source_sha256;
        record.options = canonical_text(task);
        record.failure = result.failure;
        record.facts.total_seconds = result.seconds;
        record.facts.peak_resident_bytes = std::numeric_limits<double>::quiet_NaN();
        return store_model(std::move(record), task, archive).summary;
    }
    ModelSummary summary;
    summary.identity = task.identity;
    if (!result.reply.empty()) {
        summary.failure = parse_failure(result.reply);
    } else if (std::optional<ModelSummary> row = index_row(archive, task)) {
        return std::move(*row);
    } else {
        summary.failure =
            Failure{Stage::kArchive, ErrorCode::kArchiveWrite, "the model's file cannot be read again: check the disk"};
    }
    return summary;
}

void add_worker(CLI::App& app, std::function<int()>& action) {
    auto memory = std::make_shared<double>(0);
    CLI::App* verb = app.add_subcommand("worker", "Compute models for a run with isolation: process");
    verb->group("");  // not shown: a run starts it
    verb->add_option("--memory", *memory, "Bytes beyond which a model gets none");
    verb->callback([memory, &action] { action = [memory] { return work(*memory); }; });
}

}  // namespace lumenline
