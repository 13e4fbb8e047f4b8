// Stages that split their loops give the same bytes however the ranges are run: one after the other, backwards, on
// several threads, or as one range.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

#include "engine/characterize/characterize.h"
#include "engine/voronoi/voronoi.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

using Body = std::function<void(std::size_t, std::size_t)>;

/// Ranges from the last to the first.
class Backwards : public StageContext {
public:
    using StageContext::StageContext;
    void parallel_for(std::size_t count, std::size_t grain, const Body& body) const override {
        for (std::size_t range = (count + grain - 1) / grain; range-- > 0;)
            body(range * grain, std::min((range + 1) * grain, count));
    }
};

/// One range that holds all.
class InOne : public StageContext {
public:
    using StageContext::StageContext;
    void parallel_for(std::size_t count, std::size_t, const Body& body) const override {
        if (count > 0) body(0, count);
    }
};

/// Four threads, which take ranges as they come.
class OnThreads : public StageContext {
public:
    using StageContext::StageContext;
    void parallel_for(std::size_t count, std::size_t grain, const Body& body) const override {
        std::atomic<std::size_t> next{0};
        std::vector<std::jthread> threads;
        for (int i = 0; i < 4; ++i)
            threads.emplace_back([&] {
                for (std::size_t begin = next.fetch_add(grain); begin < count; begin = next.fetch_add(grain)) {
                    body(begin, std::min(begin + grain, count));
                    ++ranges_;
                }
            });
    }
    [[nodiscard]] int ranges() const { return ranges_; }

private:
    mutable std::atomic<int> ranges_{0};
};

/// A model whose loops have several ranges each.
class LargeModel : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        PhantomOptions options;
        options.kind = PhantomKind::kHairpin;  // legs that touch: Voronoi edges are cut, and correspondence jumps
        options.points_around = 72;
        options.jitter = 0.2;
        const Phantom phantom = make_phantom(options);
        record_ = new ModelRecord(test::run_pipeline(to_soup(phantom), test::from_start_to_end(phantom.truth)));
    }
    static void TearDownTestSuite() { delete record_; }

    static SurfaceCharacter characterized(StageContext& context) {
        return characterize_surface(*record_->surface, *record_->complex, *record_->endpoints, *record_->centerlines,
                                    context);
    }
    static VoronoiComplex complex(StageContext& context) {
        return build_voronoi(*record_->surface, VoronoiOptions(), context);
    }

    static inline const ModelRecord* record_ = nullptr;
};

void expect_same(const VoronoiComplex& a, const VoronoiComplex& b) {
    EXPECT_TRUE(a.vertices == b.vertices);
    EXPECT_TRUE(a.ball_radius == b.ball_radius);
    EXPECT_TRUE(a.polygon_offsets == b.polygon_offsets);
    EXPECT_TRUE(a.polygon_vertices == b.polygon_vertices);
    EXPECT_TRUE(a.polygon_sites == b.polygon_sites);
    EXPECT_TRUE(a.vertex_polygons == b.vertex_polygons);
    EXPECT_TRUE(a.pole == b.pole);
}

/// Equal, NaN to NaN.
bool same(const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](double x, double y) { return x == y || (x != x && y != y); });
}

void expect_same(const SurfaceCharacter& a, const SurfaceCharacter& b) {
    EXPECT_TRUE(same(a.centerline_distance, b.centerline_distance));
    EXPECT_TRUE(same(a.geodesic_distance, b.geodesic_distance));
    EXPECT_TRUE(same(a.geodesic_distance_refined, b.geodesic_distance_refined));
    EXPECT_TRUE(same(a.descent_length, b.descent_length));
    EXPECT_TRUE(same(a.abscissa, b.abscissa));
    EXPECT_TRUE(a.centerline_id == b.centerline_id);
    EXPECT_TRUE(a.zone == b.zone);
    EXPECT_EQ(a.not_refined, b.not_refined);
    EXPECT_EQ(a.unreached, b.unreached);
}

TEST_F(LargeModel, ComplexIsTheSameHoweverItsRangesRun) {
    Backwards backwards(Stage::kVoronoi);
    expect_same(complex(backwards), *record_->complex);
    InOne in_one(Stage::kVoronoi);
    expect_same(complex(in_one), *record_->complex);
    OnThreads on_threads(Stage::kVoronoi);
    expect_same(complex(on_threads), *record_->complex);
    EXPECT_GT(on_threads.ranges(), 12) << "too small a model shows nothing";
}

TEST_F(LargeModel, CharacterIsTheSameHoweverItsRangesRun) {
    Backwards backwards(Stage::kCharacterize);
    expect_same(characterized(backwards), *record_->character);
    InOne in_one(Stage::kCharacterize);
    expect_same(characterized(in_one), *record_->character);
    OnThreads on_threads(Stage::kCharacterize);
    expect_same(characterized(on_threads), *record_->character);
    EXPECT_GT(on_threads.ranges(), 1) << "too small a model shows nothing";
}

}  // namespace
}  // namespace lumenline
