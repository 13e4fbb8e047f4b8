#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "engine/phantom/minimum.h"
#include "engine/phantom/phantom.h"
#include "engine/phantom/section.h"
#include "tests/phantom/shapes.h"

namespace lumenline {
namespace {

using std::numbers::pi;

constexpr double kInside[] = {0.001, 0.1, 0.237, 0.4, 0.4999, 0.5, 0.6, 0.731, 0.9, 0.999};

double size_of(const PhantomTruth& truth) { return truth.total_length() + norm(truth.position(0)); }

// Least distance from `x` to a fine sampling of the analytic wall, and a bound on how much that
// exceeds the distance to the wall itself: half the diagonal of a cell squared over twice the distance.
struct Sampled {
    double distance, excess;
};

Sampled sampled_distance(const PhantomTruth& truth, Vec3 x, double from, double to, int along, int around) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= along; ++i) {
        for (int k = 0; k < around; ++k) {
            const double s = from + (to - from) * i / along;
            least = std::min(least, squared_norm(truth.wall_point(s, 2 * pi * k / around).point - x));
        }
    }
    // Cells are largest on the outside of a bend, at most twice the axis' step.
    const double half = std::hypot(2 * (to - from) / along, 2 * pi * truth.max_section_radius() / around) / 2;
    return {std::sqrt(least), half * half / std::sqrt(least)};
}

TEST(PhantomTruth, InscribedRadiusIsTheLeastDistanceToTheWall) {
    for (const auto& [name, options] : test_shapes()) {
        const PhantomTruth truth(options);
        const double length = truth.total_length();
        for (const double share : {0.1, 0.43, 0.5, 0.55, 0.8}) {
            const double s = share * length;
            const auto [sampled, excess] = sampled_distance(truth, truth.position(s), 0, length, 1200, 120);
            EXPECT_LE(truth.inscribed_radius(s), sampled * (1 + 1e-12)) << name;
            EXPECT_GE(truth.inscribed_radius(s), sampled - excess) << name;
        }
    }
}

TEST(PhantomTruth, StenosisInscribedRadiusIsBelowTheSectionExceptAtTheThroat) {
    PhantomOptions options = shape_of(PhantomKind::kStenosis);
    const PhantomTruth truth(options);
    EXPECT_NEAR(truth.inscribed_radius(25), 2.5, 1e-14);
    EXPECT_NEAR(truth.inscribed_radius(0), 5, 1e-9);
    for (const double s : {17.0, 20.0, 23.0, 24.5, 27.0, 31.0}) {
        // Brute force along the meridian, its step refined around the best place.
        double centre = s, step = 0.01, best = 1e300;
        for (int round = 0; round < 5; ++round, step *= 0.01) {
            double least = 1e300, at = centre;
            for (int i = -1000; i <= 1000; ++i) {
                const double z = centre + i * step;
                const double q = (z - 25) / 5;
                const double d = std::hypot(z - s, 5 * (1 - 0.5 * std::exp(-q * q)));
                if (d < least) least = d, at = z;
            }
            centre = at;
            best = least;
        }
        EXPECT_NEAR(truth.inscribed_radius(s), best, 1e-12 * best);
        const Vec3 wall = truth.wall_point(s, 0).point;
        EXPECT_LT(truth.inscribed_radius(s), wall.x);
        EXPECT_NEAR(truth.inscribed_radius(s), truth.inscribed_radius(50 - s), 1e-13);
    }
}

TEST(PhantomTruth, TangentIsTheDerivativeOfThePosition) {
    for (const auto& [name, options] : test_shapes()) {
        const PhantomTruth truth(options);
        const double h = 1e-5 * truth.total_length();
        for (const double share : kInside) {
            const double s = share * truth.total_length();
            const Vec3 difference = (1 / (2 * h)) * (truth.position(s + h) - truth.position(s - h));
            // h^2/6 of the third derivative (below 1 / curvature radius^2), and, across the joint of
            // a hairpin, h/4 of the jump in curvature; rounding is 1e-16 / 1e-5 of the size.
            EXPECT_LT(norm(difference - truth.tangent(s)), 1e-4) << name;
            const AxisFrame f = truth.frame(s);
            EXPECT_NEAR(norm(f.tangent), 1, 1e-14) << name;
            EXPECT_LT(norm(cross(f.e1, f.e2) - f.tangent), 1e-14) << name;
            EXPECT_NEAR(norm(f.e1), 1, 1e-14) << name;
        }
    }
}

TEST(PhantomTruth, FrameDoesNotTurnAroundTheAxis) {
    for (const auto& [name, options] : test_shapes()) {
        const PhantomTruth truth(options);
        const double h = 1e-4 * truth.total_length();
        for (const double share : kInside) {
            const double s = share * truth.total_length();
            const double turn = dot(truth.frame(s + h).e1 - truth.frame(s - h).e1, truth.frame(s).e2);
            EXPECT_NEAR(turn, 0, 1e-6) << name;  // second order in h; a Frenet frame turns by 2 h torsion
        }
    }
}

TEST(PhantomTruth, AbscissaOfAnAxisPointIsItsOwn) {
    for (const auto& [name, options] : test_shapes()) {
        const PhantomTruth truth(options);
        for (const double share : kInside) {
            const double s = share * truth.total_length();
            EXPECT_NEAR(truth.abscissa_of(truth.position(s)), s, 1e-11 * size_of(truth)) << name;
            EXPECT_NEAR(truth.distance_to_axis(truth.position(s)), 0, 1e-12 * size_of(truth)) << name;
        }
        EXPECT_NEAR(truth.abscissa_of(truth.position(0)), 0, 1e-11 * size_of(truth)) << name;
        EXPECT_NEAR(truth.abscissa_of(truth.position(1e9)), truth.total_length(), 1e-11 * size_of(truth)) << name;
    }
}

TEST(PhantomTruth, NearestAxisPointIsThatOfAFineSampling) {
    for (const auto& [name, options] : test_shapes()) {
        const PhantomTruth truth(options);
        constexpr int kSamples = 4000;
        const double step = truth.total_length() / kSamples;
        for (const double share : {0.02, 0.3, 0.52, 0.77, 0.99}) {
            for (const double out : {0.3, 0.9, 1.7, 3.1}) {
                for (int k = 0; k < 5; ++k) {
                    const double s0 = share * truth.total_length();
                    const Vec3 x = lerp(truth.position(s0), truth.wall_point(s0, 1.3 * k).point, out);
                    double least = 1e300;
                    for (int i = 0; i <= kSamples; ++i) least = std::min(least, distance(x, truth.position(i * step)));
                    const double d = truth.distance_to_axis(x);
                    EXPECT_LE(d, least * (1 + 1e-12)) << name;
                    EXPECT_GE(d, least - step) << name;
                    EXPECT_NEAR(d, distance(x, truth.position(truth.abscissa_of(x))), 1e-12 * size_of(truth)) << name;
                    // Within the tube the nearest axis point is the section's own centre.
                    if (out < 1) {
                        EXPECT_NEAR(truth.abscissa_of(x), s0, 1e-10 * size_of(truth)) << name;
                    }
                }
            }
        }
    }
}

TEST(PhantomTruth, SignedDistanceAgreesWithSamplingOnBothSides) {
    for (const auto& [name, options] : test_shapes()) {
        const PhantomTruth truth(options);
        const double length = truth.total_length();
        const double s = 0.53 * length;
        for (const double out : {0.2, 0.85, 1.15}) {
            const Vec3 x = lerp(truth.position(s), truth.wall_point(s, 0.9).point, out);
            const auto [sampled, excess] = sampled_distance(truth, x, 0, length, 1200, 240);
            EXPECT_LE(std::fabs(truth.signed_distance(x)), sampled * (1 + 1e-11)) << name;
            EXPECT_GE(std::fabs(truth.signed_distance(x)), sampled - excess) << name;
            EXPECT_EQ(truth.signed_distance(x) > 0, out < 1) << name;
            EXPECT_EQ(truth.inside(x), out < 1) << name;
        }
        const AxisFrame start = truth.frame(0);
        const AxisFrame end = truth.frame(length);
        const double little = 0.01 * truth.min_section_radius();
        EXPECT_TRUE(truth.inside(start.origin + little * start.tangent)) << name;
        EXPECT_FALSE(truth.inside(start.origin - little * start.tangent)) << name;
        EXPECT_TRUE(truth.inside(end.origin - little * end.tangent)) << name;
        EXPECT_FALSE(truth.inside(end.origin + little * end.tangent)) << name;
    }
}

TEST(PhantomTruth, WallNormalIsPerpendicularToTheWall) {
    for (const auto& [name, options] : test_shapes()) {
        const PhantomTruth truth(options);
        const double s = 0.45 * truth.total_length();
        const double h = 1e-6;
        for (const double theta : {0.0, 0.7, 2.0, 4.4}) {
            const WallPoint w = truth.wall_point(s, theta);
            const Vec3 around = normalized(truth.wall_point(s, theta + h).point - truth.wall_point(s, theta - h).point);
            const double d = h * truth.total_length();
            const Vec3 along = normalized(truth.wall_point(s + d, theta).point - truth.wall_point(s - d, theta).point);
            // Rounding of the differences: 1e-16 of the size over 1e-6 of it, times the offset's share.
            EXPECT_NEAR(dot(w.normal, around), 0, 1e-7) << name;
            EXPECT_NEAR(dot(w.normal, along), 0, 1e-7) << name;
            EXPECT_NEAR(norm(w.normal), 1, 1e-14) << name;
            const double little = 1e-3 * truth.min_section_radius();
            EXPECT_NEAR(truth.signed_distance(w.point - little * w.normal), little, 1e-11 * size_of(truth)) << name;
        }
    }
}

TEST(PhantomTruth, EllipseDistanceIsThatOfTheNormalEverywhere) {
    for (const auto& [a, b] : {std::pair{5.0, 2.0}, {2.0, 5.0}, {5.0, 4.999999}, {5.0, 0.01}, {3.0, 3.0}}) {
        for (double t = 0; t < 6.3; t += 0.05) {
            const double x = a * std::cos(t), y = b * std::sin(t);
            const double nx = b * std::cos(t), ny = a * std::sin(t), n = std::hypot(nx, ny);
            // Inward the normal's foot stays nearest up to the least radius of curvature.
            const double reach = std::min(a, b) * std::min(a, b) / std::max(a, b);
            for (const double d : {-2.0 * a, -0.1, 0.0, 0.5 * reach, 0.99 * reach}) {
                EXPECT_NEAR(ellipse_distance(a, b, x - d * nx / n, y - d * ny / n), d, 1e-13 * std::max(a, b));
            }
        }
    }
    EXPECT_EQ(ellipse_distance(5, 2, 0, 0), 2);
    EXPECT_EQ(ellipse_distance(2, 5, 0, 0), 2);
    EXPECT_NEAR(ellipse_distance(5, 2, 4.9, 0), 0.1, 1e-15);
    // Just off the major axis the distance is that on the axis to first order.
    EXPECT_NEAR(ellipse_distance(5, 2, 1, 1e-14), ellipse_distance(5, 2, 1, 0), 2e-14);
    EXPECT_NEAR(ellipse_distance(5, 2, 4.9, 1e-300), 0.1, 1e-15);
}

TEST(PhantomTruth, ScannedMinimumFindsTheLowerOfTwoAndTheEnds) {
    const auto wells = [](double x) {  // minima near -1 and 1, the right one lower
        return Jet{std::pow(x * x - 1, 2) - 0.1 * x, 4 * x * (x * x - 1) - 0.1, 12 * x * x - 4};
    };
    const double right = scanned_minimum(wells, -2, 2, 16);
    EXPECT_NEAR(4 * right * (right * right - 1), 0.1, 1e-14);
    EXPECT_GT(right, 1);
    EXPECT_EQ(scanned_minimum(wells, 1.5, 3, 16), 1.5);
    EXPECT_EQ(scanned_minimum(wells, -4, -2, 16), -2);
}

TEST(PhantomTruth, HairpinPointsBelongToTheNearerLegAcrossANarrowGap) {
    PhantomOptions options = shape_of(PhantomKind::kHairpin);
    options.bend_radius = 5.01;
    const PhantomTruth truth(options);
    EXPECT_NEAR(truth.wall_gap(), 0.02, 1e-14);
    const double length = truth.total_length();
    EXPECT_NEAR(length, 80 + 5.01 * pi, 1e-13 * length);
    EXPECT_NEAR(truth.abscissa_of({0.001, 1, -10}), 30, 1e-13);
    EXPECT_NEAR(truth.abscissa_of({-0.001, 1, -10}), length - 30, 1e-13);
    EXPECT_NEAR(truth.distance_to_axis({0.001, 0, -10}), 5.009, 1e-13);
    EXPECT_NEAR(truth.abscissa_of({0.001, 0, 7}), length / 2, 0.01);
    EXPECT_NEAR(truth.abscissa_of({5.01, 3, -100}), 0, 0);
    EXPECT_NEAR(truth.abscissa_of({-5.01, 3, -100}), length, 1e-13);
    EXPECT_FALSE(truth.inside({0, 0, -10}));
    EXPECT_TRUE(truth.inside({0.02, 0, -10}));
}

TEST(PhantomTruth, LengthsAndRadiiAreTheGivenOnesScaled) {
    PhantomOptions options;
    options.b = 2;
    options.scale = 0.001;
    EXPECT_DOUBLE_EQ(PhantomTruth(options).total_length(), 0.05);
    EXPECT_DOUBLE_EQ(PhantomTruth(options).max_section_radius(), 0.005);
    EXPECT_DOUBLE_EQ(PhantomTruth(options).min_section_radius(), 0.002);
    EXPECT_DOUBLE_EQ(PhantomTruth(options).inscribed_radius(0.02), 0.002);
    options = shape_of(PhantomKind::kHelix);
    options.arc = 4 * pi;
    options.scale = 3;
    EXPECT_DOUBLE_EQ(PhantomTruth(options).total_length(), 3 * 2 * std::hypot(2 * pi * 20, 20));
    options = shape_of(PhantomKind::kTorus);
    EXPECT_DOUBLE_EQ(PhantomTruth(options).total_length(), 30 * pi);
    EXPECT_TRUE(std::isinf(PhantomTruth(options).wall_gap()));
}

// The turn distance against the least chord of a fine sampling, and the last accepted pitch
// against the first rejected one.
TEST(PhantomTruth, HelixIsRejectedExactlyWhenItsTurnsOverlap) {
    PhantomOptions options = shape_of(PhantomKind::kHelix);
    options.arc = 6 * pi;
    options.pitch = 12;
    double least = 1e300;
    for (double angle = 4; angle < 6 * pi; angle += 1e-5) {
        least = std::min(least, std::hypot(40 * std::sin(angle / 2), 12 * angle / (2 * pi)));
    }
    EXPECT_NEAR(PhantomTruth(options).wall_gap(), least - 10, 1e-8);  // second order in the step
    // The chord is proportional to the pitch but for the change of slope, so this closes in from above.
    for (int i = 0; i < 8; ++i) options.pitch *= (10 + 1e-6) / (10 + PhantomTruth(options).wall_gap());
    EXPECT_NEAR(PhantomTruth(options).wall_gap(), 1e-6, 1e-8);
    options.pitch *= 1 - 2e-7;
    EXPECT_THROW(PhantomTruth{options}, std::invalid_argument);
    options.arc = 1.5 * pi;  // the turns do not come to lie beside each other
    EXPECT_NO_THROW(PhantomTruth{options});
    options.pitch = 0;
    EXPECT_NO_THROW(PhantomTruth{options});
    options.arc = 2 * pi - 0.3;  // a ring whose ends overlap
    EXPECT_THROW(PhantomTruth{options}, std::invalid_argument);
}

void expect_rejected(const PhantomOptions& options, const std::string& part) {
    try {
        const PhantomTruth truth(options);
        ADD_FAILURE() << "accepted, expected: " << part;
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST(PhantomTruth, ImpossibleGeometryIsRejectedWithTheReason) {
    const auto with = [](PhantomKind kind, auto change) {
        PhantomOptions options = shape_of(kind);
        change(options);
        return options;
    };
    using enum PhantomKind;
    expect_rejected(with(kCylinder, [](auto& o) { o.b = 0; }), "semi-axis b is 0");
    expect_rejected(with(kCylinder, [](auto& o) { o.a = -1; }), "semi-axis a is -1");
    expect_rejected(with(kCylinder, [](auto& o) { o.length = std::nan(""); }), "length is nan");
    expect_rejected(with(kCylinder, [](auto& o) { o.scale = 0; }), "scale is 0");
    expect_rejected(with(kCylinder, [](auto& o) { o.offset.y = INFINITY; }), "finite");
    expect_rejected(with(kCylinder, [](auto& o) { o.rotation_axis = {}; }), "rotation axis");
    expect_rejected(with(kTorus, [](auto& o) { o.b = 4; }), "circle");
    expect_rejected(with(kTorus, [](auto& o) { o.bend_radius = 5; }), "radius of curvature 5");
    expect_rejected(with(kTorus, [](auto& o) { o.arc = 2 * pi; }), "full turn");
    expect_rejected(with(kHelix, [](auto& o) { o.bend_radius = 4, o.pitch = 10; }), "radius of curvature");
    expect_rejected(with(kHelix, [](auto& o) { o.pitch = 9, o.arc = 20; }), "pitch 9");
    expect_rejected(with(kHelix, [](auto& o) { o.pitch = INFINITY; }), "pitch is inf");
    expect_rejected(with(kStenosis, [](auto& o) { o.severity = 1; }), "severity is 1");
    expect_rejected(with(kStenosis, [](auto& o) { o.stenosis_width = 0; }), "stenosis width");
    expect_rejected(with(kHairpin, [](auto& o) { o.bend_radius = 4.9; }), "radius of curvature");
    expect_rejected(with(kHairpin, [](auto& o) { o.leg_length = 0; }), "leg length is 0");
}

}  // namespace
}  // namespace lumenline
