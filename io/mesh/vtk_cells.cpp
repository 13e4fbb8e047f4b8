// VTK numbers the cells of a dataset for its cell arrays: vertices, lines, polygons, strips in polydata, the order
// of the file in a grid. Only the number of triangles of each cell is kept, by which an array of cells becomes one
// of triangles. Vertices and lines come first in nearly every file, and as their number may be nothing but a
// number in a header, they are counted and not listed.

#include "io/mesh/vtk_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/core/text.h"

namespace lumenline::mesh {
namespace {

constexpr std::size_t kMostLabels = 32;  // bounds the memory that one cell of very many corners can ask for

bool is_label(double value) {
    using Limits = std::numeric_limits<std::int32_t>;
    return value >= Limits::min() && value <= Limits::max() && value == std::trunc(value);
}

}  // namespace

void VtkCells::begin_piece() {
    leading_ = 0;
    triangle_counts_.clear();
    piece_begin_ = triangles_;
}

void VtkCells::skip(std::uint64_t count) {
    skipped_ += count;
    if (triangle_counts_.empty()) {
        leading_ += count;
    } else {
        triangle_counts_.resize(triangle_counts_.size() + count, 0);
    }
}

void VtkCells::add_polygon(std::span<const std::uint32_t> corners, std::size_t position) {
    faces_.add(corners, position);
    triangle_counts_.push_back(static_cast<std::uint32_t>(corners.size() - 2));
    triangles_ += corners.size() - 2;
}

void VtkCells::add_strip(std::span<const std::uint32_t> corners, std::size_t position) {
    if (corners.size() < 3) faces_.add(corners, position);  // which refuses it
    for (std::size_t i = 2; i < corners.size(); ++i) {
        // Every other triangle of a strip runs backwards.
        const std::size_t odd = i % 2;
        faces_.add(std::array{corners[i - 2 + odd], corners[i - 1 - odd], corners[i]}, position);
    }
    triangle_counts_.push_back(static_cast<std::uint32_t>(corners.size() - 2));
    triangles_ += corners.size() - 2;
}

bool VtkCells::takes_arrays() const { return labels_.size() < kMostLabels; }

void VtkCells::add_array(const std::string& name, std::span<const double> values) {
    if (!std::all_of(values.begin(), values.end(), is_label)) return;
    auto found = std::find_if(labels_.begin(), labels_.end(), [&](const CellLabels& l) { return l.name == name; });
    if (found == labels_.end()) {
        if (!takes_arrays()) return;
        found = labels_.insert(labels_.end(), CellLabels{name, {}});
    }
    if (found->values.size() != piece_begin_) return;  // not of every piece, or a second array of this name
    found->values.reserve(triangles_);
    for (std::size_t i = 0; i < triangle_counts_.size(); ++i) {
        found->values.insert(found->values.end(), triangle_counts_[i], static_cast<std::int32_t>(values[leading_ + i]));
    }
}

void VtkCells::report_unread(const std::string& sentence) {
    diagnostics_.push_back({"cell_arrays_unread", Severity::kWarning, Stage::kLoad, sentence});
}

TriangleSoup VtkCells::make_soup(std::vector<Vec3> points, int digits) {
    if (triangles_ == 0 && skipped_ > 0) {
        fail_file(file_, ErrorCode::kNoSurface,
                  "expected at least one triangle or polygon, found only " + counted(skipped_, "cell") +
                      " that are vertices or lines, as in a file of centerlines");
    }
    TriangleSoup soup = mesh::make_soup(file_, std::move(points), faces_, digits);
    std::erase_if(labels_, [&](const CellLabels& l) { return l.values.size() != soup.triangles.size(); });
    soup.cell_labels = std::move(labels_);
    if (skipped_ > 0) {
        diagnostics_.push_back({"cells_ignored", Severity::kNote, Stage::kLoad,
                                counted(skipped_, "cell") + " of the file that are vertices or lines are ignored",
                                static_cast<double>(skipped_)});
    }
    soup.diagnostics = std::move(diagnostics_);
    return soup;
}

}  // namespace lumenline::mesh
