#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/mesh/faces.h"

namespace lumenline::mesh {

/// Cells of a VTK dataset in the order of its cell arrays, as triangles with labels.
///
/// A dataset comes in one or several pieces, each with cells and then cell arrays of its own.
class VtkCells {
public:
    explicit VtkCells(const SourceFile& file) : file_(file), faces_(file) {}

    /// Begins the next piece; the first one is begun already.
    void begin_piece();
    /// Adds cells that are no part of a surface: vertices and lines.
    void skip(std::uint64_t count);
    /// Adds one cell; `position` is where it stands, for messages.
    /// @throws StageError kFileFormat with fewer than three corners, kTooLarge
    void add_polygon(std::span<const std::uint32_t> corners, std::size_t position);
    void add_strip(std::span<const std::uint32_t> corners, std::size_t position);

    /// Number of cells of the piece so far.
    [[nodiscard]] std::uint64_t cells() const { return leading_ + triangle_counts_.size(); }
    /// Whether one more cell array would be kept: no file needs more than a few.
    [[nodiscard]] bool takes_arrays() const;
    /// Keeps an array as labels if its values are whole numbers of 32 bits.
    /// @param values  one for each cell of the piece
    void add_array(const std::string& name, std::span<const double> values);
    /// Reports why arrays could not be read, as a warning.
    void report_unread(const std::string& sentence);

    /// Finished soup but for source_file and source_sha256; labels that not every piece has are left out.
    /// @param digits  as make_soup() in faces.h
    /// @throws StageError kNoSurface without any triangle
    TriangleSoup make_soup(std::vector<Vec3> points, int digits);

private:
    const SourceFile& file_;
    FaceCollector faces_;
    std::uint64_t leading_ = 0;                   // skipped cells before the first other one of the piece
    std::vector<std::uint32_t> triangle_counts_;  // of each cell behind them
    std::uint64_t triangles_ = 0;                 // of all pieces
    std::uint64_t piece_begin_ = 0;               // first triangle of the piece
    std::uint64_t skipped_ = 0;                   // cells of all pieces
    std::vector<CellLabels> labels_;
    Diagnostics diagnostics_;
};

}  // namespace lumenline::mesh
