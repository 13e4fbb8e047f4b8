// Whole numbers on cells become labels of triangles, in every storage; other arrays are passed over, and damage
// among them is reported and costs no surface.

#include <gtest/gtest.h>

#include "engine/core/errors.h"
#include "io/mesh/formats.h"
#include "tests/mesh/refusal.h"
#include "tests/mesh/vtk_samples.h"

namespace lumenline {
namespace {

using samples::vtp_file;
using samples::VtpPiece;
using samples::VtpStyle;
using Values = std::vector<std::int32_t>;

TriangleSoup parse(const std::string& bytes) { return mesh::parse_surface({"a", bytes}); }

// Null if there are none of this name.
const Values* labels(const TriangleSoup& soup, const std::string& name) {
    const Values* found = nullptr;
    for (const CellLabels& l : soup.cell_labels) {
        if (l.name != name) continue;
        EXPECT_EQ(found, nullptr) << "two arrays " << name;
        found = &l.values;
    }
    return found;
}

void expect_labels(const TriangleSoup& soup, const std::string& name, const Values& values) {
    const Values* found = labels(soup, name);
    ASSERT_NE(found, nullptr) << name;
    EXPECT_EQ(*found, values) << name;
}

void expect_diagnostic(const TriangleSoup& soup, const std::string& code, const std::string& part) {
    ASSERT_EQ(soup.diagnostics.size(), 1U);
    EXPECT_EQ(soup.diagnostics[0].code, code);
    EXPECT_NE(soup.diagnostics[0].message.find(part), std::string::npos) << soup.diagnostics[0].message;
}

TEST(CellLabels, WholeNumbersOfVtpCellsInEveryStorage) {
    for (const auto& [name, style] : samples::vtp_styles()) {
        SCOPED_TRACE(name);
        const TriangleSoup soup = parse(vtp_file({samples::tetrahedron_piece()}, style));
        EXPECT_EQ(soup.cell_labels.size(), 2U);
        expect_labels(soup, "ModelFaceID", samples::tetrahedron_piece_faces());
        expect_labels(soup, "Ids", samples::tetrahedron_piece_ids());
        expect_diagnostic(soup, "cells_ignored", "2 cells");
    }
}

TEST(CellLabels, LegacyCellDataOfEveryKindInTextAndBinary) {
    for (const bool binary : {false, true}) {
        SCOPED_TRACE(binary ? "binary" : "text");
        const TriangleSoup soup = parse(samples::legacy_with_attributes(binary));
        EXPECT_EQ(soup.cell_labels.size(), 3U);
        for (const std::string name : {"ModelFaceID", "Ids", "Model Face"}) {
            expect_labels(soup, name, {10, 20, 30, 40});
        }
        expect_diagnostic(soup, "cells_ignored", "1 cell ");
    }
}

TEST(CellLabels, GridCellsInTheOrderOfTheFile) {
    const TriangleSoup soup = parse(samples::named("grid.vtk").bytes);
    expect_labels(soup, "ModelFaceID", {10, 20, 3, 3});
    expect_diagnostic(soup, "cells_ignored", "2 cells");
}

TEST(CellLabels, EveryTriangleOfAPolygonHasItsLabel) {
    VtpPiece piece;
    piece.points = {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}, {-1, 0.5, 0}};
    piece.polys = {{0, 1, 2, 3, 4}, {0, 1, 2}, {0, 1, 2, 3}};
    piece.cell_arrays = {{"id", "UInt8", {1, 2, 3}}};
    expect_labels(parse(vtp_file({piece}, {})), "id", {1, 1, 1, 2, 3, 3});
}

TEST(CellLabels, OnlyArraysOfAllPiecesAreKept) {
    VtpPiece first = samples::tetrahedron_piece();
    VtpPiece second = first;
    second.cell_arrays = {first.cell_arrays[0]};
    for (const auto& pieces : {std::vector{first, second}, std::vector{second, first}}) {
        const TriangleSoup soup = parse(vtp_file(pieces, {VtpStyle::Format::kAppendedRaw}));
        EXPECT_EQ(soup.cell_labels.size(), 1U);
        expect_labels(soup, "ModelFaceID", {10, 20, 30, 30, 10, 20, 30, 30});
    }
}

TEST(CellLabels, ArrayWithAValueBeyondThirtyTwoBitsOrBetweenIsNone) {
    for (const double value : {0.5, 2147483648.0, -2147483649.0, 1e300}) {
        VtpPiece piece = samples::tetrahedron_piece();
        piece.cell_arrays = {{"x", "Float64", {0, 0, 1, 2, value}}};
        EXPECT_TRUE(parse(vtp_file({piece}, {VtpStyle::Format::kBinary})).cell_labels.empty()) << value;
    }
    VtpPiece piece = samples::tetrahedron_piece();
    piece.cell_arrays = {{"x", "Float64", {0, 0, -2147483648.0, 2147483647, 0}}};
    EXPECT_EQ(parse(vtp_file({piece}, {VtpStyle::Format::kBinary})).cell_labels.size(), 1U);
}

TEST(CellLabels, DamagedArrayIsReportedAndTheSurfaceRead) {
    const std::string text = vtp_file({samples::tetrahedron_piece()}, {});
    const TriangleSoup soup = parse(samples::replaced(text, "-1 -2 10 20 30", "-1 -2 10 20"));
    EXPECT_EQ(samples::corners_of(soup), samples::tetrahedron_piece_corners());
    EXPECT_EQ(labels(soup, "ModelFaceID"), nullptr);
    expect_labels(soup, "Ids", samples::tetrahedron_piece_ids());
    ASSERT_EQ(soup.diagnostics.size(), 2U);
    EXPECT_EQ(soup.diagnostics[0].code, "cell_arrays_unread");
    EXPECT_EQ(soup.diagnostics[0].severity, Severity::kWarning);
    EXPECT_NE(soup.diagnostics[0].message.find("line 9: expected a number, found the end of the array"),
              std::string::npos)
        << soup.diagnostics[0].message;
}

TEST(CellLabels, DamagedLegacyAttributesCostTheLabelsBehindThem) {
    const std::string text = samples::legacy_with_attributes(false);
    const std::size_t cut = text.find("SCALARS ModelFaceID");
    for (const std::string& bytes :
         {text.substr(0, cut) + "SCALARS ModelFaceID int\nLOOKUP_TABLE default\n1 2 3", text.substr(0, cut) + "WHAT",
          samples::replaced(text, "NORMALS cn float", "NORMALS cn flat"),
          samples::replaced(text, "NORMALS cn float", "NORMALS cn")}) {
        const TriangleSoup soup = parse(bytes);
        EXPECT_EQ(samples::corners_of(soup), samples::corners_of(samples::tetrahedron()));
        expect_labels(soup, "Ids", {10, 20, 30, 40});
        EXPECT_EQ(labels(soup, "ModelFaceID"), nullptr);
        ASSERT_EQ(soup.diagnostics.size(), 2U);
        EXPECT_EQ(soup.diagnostics[0].code, "cell_arrays_unread");
    }
    const TriangleSoup none = parse(samples::replaced(text, "CELL_DATA 5\nSCALARS Ids", "CELL_DATA 4\nSCALARS Ids"));
    EXPECT_TRUE(none.cell_labels.empty());
    ASSERT_EQ(none.diagnostics.size(), 2U);
    EXPECT_NE(none.diagnostics[0].message.find("5, found 4"), std::string::npos) << none.diagnostics[0].message;
}

// The surface stands before the attributes: a file cut among them loses labels, never triangles.
TEST(CellLabels, LegacyFileCutAmongItsAttributesKeepsItsSurface) {
    for (const bool binary : {false, true}) {
        const std::string whole = samples::legacy_with_attributes(binary);
        std::size_t most = 0;
        for (std::size_t size = whole.find("POINT_DATA") + 10; size < whole.size(); ++size) {
            // An exact allocation, so that the address sanitizer sees any byte read behind the end.
            const std::vector<char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
            const TriangleSoup soup = mesh::parse_surface({"a", {cut.data(), cut.size()}});
            ASSERT_EQ(samples::corners_of(soup), samples::corners_of(samples::tetrahedron())) << size;
            for (const CellLabels& l : soup.cell_labels) ASSERT_EQ(l.values.size(), 4U) << size;
            ASSERT_GE(soup.cell_labels.size(), most) << size;
            most = soup.cell_labels.size();
        }
        EXPECT_EQ(most, 3U);
    }
}

TEST(CellLabels, UnorderedLegacySectionsAreReportedAndHaveNone) {
    const std::string bytes =
        "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0\n1 0 0\n0 1 0\n"
        "TRIANGLE_STRIPS 1 4\n3 0 1 2\nPOLYGONS 1 4\n3 2 1 0\nCELL_DATA 2\nSCALARS id int\nLOOKUP_TABLE default\n1 2\n";
    const TriangleSoup soup = parse(bytes);
    EXPECT_EQ(soup.triangles.size(), 2U);
    EXPECT_TRUE(soup.cell_labels.empty());
    expect_diagnostic(soup, "cell_arrays_unread", "order");
}

TEST(CellLabels, NoMoreThanThirtyTwoArraysAreKept) {
    VtpPiece piece = samples::tetrahedron_piece();
    piece.cell_arrays.clear();
    for (int i = 0; i < 40; ++i) piece.cell_arrays.push_back({std::to_string(i), "Int8", {0, 0, 1, 2, 3}});
    EXPECT_EQ(parse(vtp_file({piece}, {})).cell_labels.size(), 32U);
}

}  // namespace
}  // namespace lumenline
