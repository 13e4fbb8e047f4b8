// The scheduler against its promises: the same records at any thread count and from the serial
// path, isolated failures, several sources, a bound on the models in flight, stopping.
#include "engine/schedule/run_models.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include "engine/phantom/phantom.h"

namespace lumenline {
namespace {

ModelTask task(const std::string& id, int seed) {
    ModelTask t;
    t.identity.id = id;
    t.surface_path = id;
    t.scale = seed;  // the test's loader reads it as the phantom's seed
    t.options.condition.check_self_intersections = false;
    return t;
}

std::vector<ModelTask> cohort(int count) {
    std::vector<ModelTask> tasks;
    for (int i = 0; i < count; ++i) tasks.push_back(task("tube" + std::to_string(i), i + 1));
    return tasks;
}

TriangleSoup load_tube(const ModelTask& t) {
    PhantomOptions options;
    options.b = 3;
    options.length = 20 + 5 * (static_cast<int>(t.scale) % 3);
    options.points_around = 16;
    options.jitter = 0.2;
    options.seed = static_cast<std::uint64_t>(t.scale);
    return to_soup(make_phantom(options));
}

std::map<std::string, ModelRecord> run(const std::vector<ModelTask>& tasks, int threads,
                                       const Loader& loader = load_tube, int in_flight = 0) {
    std::map<std::string, ModelRecord> records;
    ScheduleOptions options;
    options.threads = threads;
    options.models_in_flight = in_flight;
    const RunReport report = run_models(tasks, options, loader, [&](ModelRecord&& record) {
        const std::string id = record.identity.id;
        EXPECT_TRUE(records.emplace(id, std::move(record)).second) << id << " came twice";
    });
    EXPECT_EQ(records.size(), tasks.size());
    EXPECT_EQ(report.ok + report.warning + report.failed, tasks.size());
    return records;
}

/// Everything of a record but its facts, bit for bit.
void expect_same(const ModelRecord& a, const ModelRecord& b) {
    ASSERT_EQ(a.status, b.status);
    ASSERT_EQ(a.diagnostics.size(), b.diagnostics.size());
    for (std::size_t i = 0; i < a.diagnostics.size(); ++i)
        EXPECT_EQ(a.diagnostics[i].message, b.diagnostics[i].message);
    ASSERT_EQ(a.failure.has_value(), b.failure.has_value());
    if (a.failure) {
        EXPECT_EQ(a.failure->sentence, b.failure->sentence);
        return;
    }
    EXPECT_EQ(a.surface->points, b.surface->points);
    EXPECT_EQ(a.surface->triangles, b.surface->triangles);
    EXPECT_EQ(a.complex->vertices, b.complex->vertices);
    EXPECT_EQ(a.complex->polygon_vertices, b.complex->polygon_vertices);
    EXPECT_EQ(a.complex->pole, b.complex->pole);
    ASSERT_EQ(a.fields.size(), b.fields.size());
    for (std::size_t i = 0; i < a.fields.size(); ++i) {
        EXPECT_EQ(a.fields[i]->source, b.fields[i]->source);
        EXPECT_EQ(a.fields[i]->time, b.fields[i]->time);
    }
    EXPECT_EQ(a.centerlines->points, b.centerlines->points);
    EXPECT_EQ(a.centerlines->clearance, b.centerlines->clearance);
    EXPECT_EQ(a.centerlines->source, b.centerlines->source);
}

TEST(RunModels, AnyThreadCountAndTheSerialPathGiveTheSameBits) {
    const std::vector<ModelTask> tasks = cohort(12);
    const auto one = run(tasks, 1);
    for (const int threads : {2, 5}) {
        const auto many = run(tasks, threads);
        for (const auto& [id, record] : one) {
            SCOPED_TRACE(id);
            expect_same(record, many.at(id));
        }
    }
    for (const ModelTask& t : tasks) expect_same(process_model(t, load_tube), one.at(t.identity.id));
    for (const auto& [id, record] : one) EXPECT_NE(record.status, ModelStatus::kFailed) << record.failure->sentence;
}

TEST(RunModels, EverySourceIsSolvedInEndpointOrder) {
    std::vector<ModelTask> tasks = cohort(3);
    for (ModelTask& t : tasks) {  // both ends are inlets, the middle is the outlet
        t.options.endpoints.inlets = {{0, 0, 0}, {0, 0, 20.0 + 5 * (static_cast<int>(t.scale) % 3)}};
        t.options.endpoints.outlets = {{0, 0, 8}};
        t.options.trace.pairs = Pairs::kAll;
    }
    const auto one = run(tasks, 1);
    const auto four = run(tasks, 4);
    for (const auto& [id, record] : one) {
        ASSERT_EQ(record.status == ModelStatus::kFailed, false) << record.failure->sentence;
        ASSERT_EQ(record.fields.size(), 2U);
        EXPECT_EQ(record.fields[0]->source, EndpointId(0));
        EXPECT_EQ(record.fields[1]->source, EndpointId(1));
        EXPECT_EQ(record.centerlines->line_count(), 2U);
        expect_same(record, four.at(id));
    }
}

TEST(RunModels, OneFailureHarmsNoOther) {
    const std::vector<ModelTask> tasks = cohort(8);
    const Loader loader = [](const ModelTask& t) -> TriangleSoup {
        if (t.identity.id == "tube1") throw StageError(Stage::kLoad, ErrorCode::kFileFormat, "tube1 is no surface");
        if (t.identity.id == "tube3") throw std::runtime_error("broken");
        if (t.identity.id == "tube4") throw std::bad_alloc();
        if (t.identity.id == "tube5") return TriangleSoup{};
        return load_tube(t);
    };
    const auto records = run(tasks, 3, loader);
    EXPECT_EQ(records.at("tube1").failure->sentence, "tube1 is no surface");
    EXPECT_EQ(records.at("tube1").failure->code, ErrorCode::kFileFormat);
    EXPECT_EQ(records.at("tube3").failure->code, ErrorCode::kInternal);
    EXPECT_EQ(records.at("tube4").failure->code, ErrorCode::kOutOfMemory);
    EXPECT_EQ(records.at("tube5").failure->code, ErrorCode::kNoSurface);
    EXPECT_EQ(records.at("tube5").failure->stage, Stage::kCondition);
    for (const char* good : {"tube0", "tube2", "tube6", "tube7"})
        expect_same(records.at(good), process_model(tasks[static_cast<std::size_t>(good[4] - '0')], load_tube));
}

TEST(RunModels, NoMoreModelsAreInFlightThanAllowed) {
    for (const int allowed : {1, 2, 3}) {
        std::atomic<int> inside{0}, most{0};
        const std::vector<ModelTask> tasks = cohort(10);
        ScheduleOptions options;
        options.threads = 4;
        options.models_in_flight = allowed;
        const Loader loader = [&](const ModelTask& t) {
            const int now = ++inside;
            for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
            }
            return load_tube(t);
        };
        run_models(tasks, options, loader, [&](ModelRecord&&) { --inside; });
        EXPECT_LE(most, allowed);
        EXPECT_EQ(inside, 0);
    }
}

/// Runs models of given needs within 10 bytes; returns ids in the order in which they were loaded.
std::vector<std::string> run_within_budget(const std::vector<double>& needs, int threads, double& most,
                                           bool& large_ones_alone) {
    const std::vector<ModelTask> tasks = cohort(static_cast<int>(needs.size()));
    const auto need = [&](const ModelTask& t) { return needs[std::stoul(t.identity.id.substr(4))]; };
    std::mutex mutex;
    std::multiset<double> inside;
    std::vector<std::string> order;
    most = 0;
    large_ones_alone = true;
    const auto look = [&] {
        double sum = 0;
        for (const double bytes : inside) sum += bytes;
        if (inside.size() > 1) most = std::max(most, sum);
        if (inside.size() > 1 && *inside.rbegin() > 10) large_ones_alone = false;
    };
    ScheduleOptions options;
    options.threads = threads;
    options.models_in_flight = 4;
    options.memory = 10;
    options.memory_of = need;
    const Loader loader = [&](const ModelTask& t) {
        const std::lock_guard lock(mutex);
        inside.insert(need(t));
        order.push_back(t.identity.id);
        look();
        return TriangleSoup{};  // fails in the next stage: what counts is who is inside
    };
    std::size_t stored = 0;
    run_models(tasks, options, loader, [&](ModelRecord&& record) {
        const std::lock_guard lock(mutex);
        ++stored;
        for (const ModelTask& t : tasks)
            if (t.identity.id == record.identity.id) inside.erase(inside.find(need(t)));
    });
    EXPECT_EQ(stored, needs.size());
    return order;
}

TEST(RunModels, EstimatedMemoryStaysWithinTheBudgetAndLargerModelsRunAlone) {
    for (const int threads : {1, 4}) {
        double most = 0;
        bool large_ones_alone = false;
        run_within_budget({12, 6, 5, 4, 4, 30, 3, 3, 2, 2, 1, 1, 1, 11, 0, 0}, threads, most, large_ones_alone);
        EXPECT_LE(most, 10);
        EXPECT_TRUE(large_ones_alone);
    }
}

TEST(RunModels, AModelThatWaitsForMemoryIsPassedByFewSmallerOnes) {
    // One byte is always in use by some small one, so the 10 would wait to the end if smaller ones passed for ever.
    std::vector<double> needs(40, 1);
    needs[1] = 10;
    double most = 0;
    bool large_ones_alone = false;
    const std::vector<std::string> order = run_within_budget(needs, 1, most, large_ones_alone);
    const auto at = std::find(order.begin(), order.end(), "tube1") - order.begin();
    EXPECT_LE(at, 1 + 4) << "as many as may be in flight";
}

TEST(RunModels, ModelsStartInTheOrderGivenHoweverManyAreInFlight) {
    for (const int in_flight : {1, 3, 10}) {
        std::vector<std::string> order;
        ScheduleOptions options;
        options.threads = 1;
        options.models_in_flight = in_flight;
        const Loader loader = [&](const ModelTask& t) {
            order.push_back(t.identity.id);
            return TriangleSoup{};
        };
        run_models(cohort(5), options, loader, [](ModelRecord&&) {});
        EXPECT_EQ(order, (std::vector<std::string>{"tube0", "tube1", "tube2", "tube3", "tube4"})) << in_flight;
    }
}

TEST(RunModels, ModelBeyondItsTimeFailsAtTheNextStageAndTheOthersComplete) {
    const std::vector<ModelTask> tasks = cohort(3);
    ScheduleOptions options;
    options.threads = 2;
    options.model_timeout = 100;
    const Loader loader = [](const ModelTask& t) { return load_tube(t); };
    run_models(tasks, options, loader, [](ModelRecord&& record) { EXPECT_NE(record.status, ModelStatus::kFailed); });
    options.model_timeout = 1e-9;  // less than any load takes
    run_models(tasks, options, loader, [](ModelRecord&& record) {
        ASSERT_TRUE(record.failure);
        EXPECT_EQ(record.failure->code, ErrorCode::kTimeout);
        EXPECT_EQ(record.failure->stage, Stage::kCondition);
        EXPECT_TRUE(is_transient(record.failure->code));
    });
}

TEST(RunModels, TheSinkIsNeverEnteredTwiceAtOnce) {
    std::atomic<bool> busy{false};
    ScheduleOptions options;
    options.threads = 4;
    const std::vector<ModelTask> tasks = cohort(12);
    run_models(tasks, options, load_tube, [&](ModelRecord&&) {
        EXPECT_FALSE(busy.exchange(true));
        std::this_thread::yield();
        busy = false;
    });
}

TEST(RunModels, StoppingAdmitsNoMoreAndReportsTheRest) {
    std::atomic<bool> stop{false};
    std::size_t stored = 0;
    ScheduleOptions options;
    options.threads = 2;
    options.models_in_flight = 2;
    options.cancelled = &stop;
    const std::vector<ModelTask> tasks = cohort(20);
    const RunReport report = run_models(tasks, options, load_tube, [&](ModelRecord&& record) {
        EXPECT_FALSE(record.failure && record.failure->code == ErrorCode::kInterrupted);
        if (++stored == 3) stop = true;
    });
    EXPECT_GE(stored, 3U);
    EXPECT_GT(report.not_started, 0U);
    EXPECT_EQ(stored + report.interrupted + report.not_started, tasks.size());
}

TEST(RunModels, WhatTheSinkThrowsEndsTheRunAndReachesTheCaller) {
    const std::vector<ModelTask> tasks = cohort(10);
    ScheduleOptions options;
    options.threads = 3;
    int calls = 0;
    const Sink sink = [&](ModelRecord&&) {
        ++calls;
        throw std::runtime_error("disk full");
    };
    EXPECT_THROW(run_models(tasks, options, load_tube, sink), std::runtime_error);
    EXPECT_EQ(calls, 1);
}

TEST(RunModels, AnEmptyCohortIsDoneAtOnce) {
    const RunReport report = run_models({}, {}, load_tube, [](ModelRecord&&) { FAIL(); });
    EXPECT_EQ(report.ok + report.failed + report.not_started, 0U);
}

}  // namespace
}  // namespace lumenline
