#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace lumenline {

/// A named array of a polydata: `components` numbers a point or a cell.
struct PolyDataArray {
    std::string name;
    std::size_t components = 1;
    std::vector<double> values;
    bool is_integer = false;
};

/// Cells as lists of points.
struct PolyDataCells {
    std::vector<std::int64_t> connectivity, offsets;  ///< offsets: end of each cell, as VTK has them

    void add(const std::vector<std::int64_t>& points) {
        connectivity.insert(connectivity.end(), points.begin(), points.end());
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    }
};

/// What a .vtp file holds. Cell arrays run over the lines, then the polygons.
struct PolyData {
    std::vector<double> points;  ///< x, y, z each
    PolyDataCells lines, polygons;
    std::vector<PolyDataArray> point_arrays, cell_arrays;
};

/// Writes VTK XML polydata, its numbers in base64. The file appears when it is complete. @throws std::system_error
void write_polydata(const std::filesystem::path& file, const PolyData& data);

}  // namespace lumenline
