// The rounding that a file's coordinates carry, by kind of file.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/mesh/faces.h"
#include "io/mesh/formats.h"
#include "tests/mesh/samples.h"
#include "tests/mesh/vtk_samples.h"

namespace lumenline {
namespace {

double rounding_of_text(const std::string& a, const std::string& b, const std::string& c) {
    return mesh::parse_surface({"a.off", "OFF 3 1\n" + a + "\n" + b + "\n" + c + "\n3 0 1 2\n"}).coordinate_rounding;
}

TEST(CoordinateRounding, BinaryFloatsRoundAtTwentyFourBits) {
    EXPECT_EQ(mesh::parse_surface({"a", samples::named("binary.stl").bytes}).coordinate_rounding, std::ldexp(3.0, -24));
    EXPECT_EQ(mesh::parse_surface({"a", samples::named("float.vtk").bytes}).coordinate_rounding, std::ldexp(3.0, -24));
    EXPECT_EQ(mesh::parse_surface({"a", samples::named("big.ply").bytes}).coordinate_rounding, std::ldexp(3.0, -24));
}

TEST(CoordinateRounding, VtpRoundsByItsNumbersAndNotByItsDeclaration) {
    samples::VtpPiece piece = samples::tetrahedron_piece();
    for (auto [name, style] : samples::vtp_styles()) {
        if (name == "ascii") continue;
        for (const std::string type : {"Float32", "Float64"}) {
            style.point_type = type;
            piece.points[1].x = 1.5;
            const std::string floats = samples::vtp_file({piece}, style);
            EXPECT_EQ(mesh::parse_surface({"a", floats}).coordinate_rounding, std::ldexp(3.0, -24)) << name << type;
            piece.points[1].x = 0.1;
            const std::string tenth = samples::vtp_file({piece}, style);
            EXPECT_EQ(mesh::parse_surface({"a", tenth}).coordinate_rounding,
                      std::ldexp(3.0, type == "Float32" ? -24 : -53))
                << name << type;
        }
    }
    // As text: 0.12345 has five digits, so that 3 is known to 0.5e-4. Relative tolerance 1e-12: a computed power.
    piece.points[1].x = 0.12345;
    EXPECT_NEAR(mesh::parse_surface({"a", samples::vtp_file({piece}, {})}).coordinate_rounding, 5e-5, 5e-17);
}

TEST(CoordinateRounding, BinaryDoublesRoundAtFiftyThreeBitsUnlessAllAreFloats) {
    const std::vector<Vec3> floats{{0.5, -8, 0}};
    const std::vector<Vec3> doubles{{0.1, -8, 0}};
    const std::vector<Vec3> huge{{1e300, 0, 0}};
    EXPECT_EQ(mesh::coordinate_rounding(floats, 0), std::ldexp(8.0, -24));
    EXPECT_EQ(mesh::coordinate_rounding(doubles, 0), std::ldexp(8.0, -53));
    EXPECT_EQ(mesh::coordinate_rounding(huge, 0), std::ldexp(1e300, -53));
}

TEST(CoordinateRounding, FloatsAreKnownAtTheEndsOfTheirRange) {
    const auto is_float = [](double x) {
        const std::vector<Vec3> points{{x, x, 8}};
        return mesh::coordinate_rounding(points, 0) == std::ldexp(std::max(8.0, std::fabs(x)), -24);
    };
    using Float = std::numeric_limits<float>;
    for (const float x : {Float::max(), Float::min(), Float::denorm_min(), 0.1F, -0.0F, 3 * Float::denorm_min()}) {
        EXPECT_TRUE(is_float(x)) << x;
        EXPECT_TRUE(is_float(-x)) << x;
    }
    const double above = std::ldexp(1.0, 128);
    for (const double x : {above, 0.1, std::ldexp(1.5, -149), std::ldexp(1.0, -150), 1 + std::ldexp(1.0, -24)}) {
        EXPECT_FALSE(is_float(x)) << x;
        EXPECT_FALSE(is_float(-x)) << x;
    }
    EXPECT_TRUE(is_float(1 + std::ldexp(1.0, -23)));
}

// Relative tolerance 1e-12: the powers of ten are computed, not exact.
TEST(CoordinateRounding, TextRoundsAtItsLastPrintedDigit) {
    EXPECT_NEAR(rounding_of_text("-390.630920 0 0", "31.466864 1 0", "0 0.1 0"), 5e-7, 5e-19);  // %.6f
    EXPECT_NEAR(rounding_of_text("12.3456 0 0", "0.0123457 0 0", "0 1 0"), 5e-5, 5e-17);        // %.6g
    EXPECT_NEAR(rounding_of_text("1.23456e+03 0 0", "0 1.1e2 0", "0 1 0.7"), 5e-3, 5e-15);      // %.5e
    EXPECT_NEAR(rounding_of_text("0.00012 0 0", "0 0.00013 0", "0 0 0.000001"), 5e-6, 5e-18);
}

TEST(CoordinateRounding, LargestCoordinateMayBeAPowerOfTen) {
    EXPECT_NEAR(rounding_of_text("10.0 0 0", "0 9.9 0", "0 0 1"), 0.05, 5e-14);
    EXPECT_NEAR(rounding_of_text("-1000 0 0", "0 999 0", "0 0 1"), 0.5, 5e-13);
    EXPECT_NEAR(rounding_of_text("0.00100 0 0", "0 0.00099 0", "0 0 0"), 5e-6, 5e-18);
    EXPECT_NEAR(rounding_of_text("1e5 0 0", "0 1e4 0", "0 0 1"), 5e4, 5e-8);
    EXPECT_NEAR(rounding_of_text("1.0e-9 0 0", "0 9.9e-10 0", "0 0 0"), 5e-11, 5e-23);
    EXPECT_NEAR(rounding_of_text("9.99 0 0", "0 1 0", "0 0 1"), 0.005, 5e-15) << "one step below one";
}

TEST(CoordinateRounding, TextOfManyDigitsRoundsAsTheNumberItself) {
    // Half a unit of the seventeenth digit is 5e-17, half the last bit of the double 3.4e-16.
    EXPECT_EQ(rounding_of_text("3.1000000000000000888 0 0", "0 0.1 0", "0 0 1"), std::ldexp(3.1, -53));
}

TEST(CoordinateRounding, TextOfFloatsRoundsNoFinerThanFloats) {
    const double tenth = static_cast<double>(0.1F);
    EXPECT_EQ(rounding_of_text("0.100000001490116119384765625 0 0", "0 0.5 0", "0 0 2"), std::ldexp(2.0, -24));
    EXPECT_EQ(rounding_of_text("0.100000001490116119384765625 0 0", "0 0 0", "0 0 0"), std::ldexp(tenth, -24));
}

TEST(CoordinateRounding, AllZeroCoordinatesHaveNone) { EXPECT_EQ(rounding_of_text("0 0 0", "0 0 0", "-0.0 0 0"), 0); }

}  // namespace
}  // namespace lumenline
