// Arrays that run over the points of a part are found by their length and exported under their own names; those that
// VMTK's scripts ask for are added under its names.
#include "io/export/vtp.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "io/archive/line_names.h"
#include "io/archive/names.h"
#include "io/export/polydata.h"

namespace lumenline {

namespace {

using Names = std::vector<std::pair<std::string, std::string>>;  // of the archive, of VMTK

class Model {
public:
    explicit Model(const ArchiveFile& file) : file_(file), nodes_(file.nodes()) {}

    [[nodiscard]] bool has(const std::string& path) const { return find(path) != nullptr; }

    [[nodiscard]] std::vector<double> numbers(const std::string& path) const { return file_.numbers(path); }

    /// Index arrays; each value from `least` to below `end`.
    [[nodiscard]] std::vector<std::int64_t> indices(const std::string& path, std::int64_t least,
                                                    std::size_t end) const {
        std::vector<std::int64_t> result;
        for (const double v : file_.numbers(path)) {
            if (!(v >= static_cast<double>(least) && v < static_cast<double>(end))) contradiction(path);
            result.push_back(static_cast<std::int64_t>(v));
        }
        return result;
    }

    /// Offsets into `count` values: ascending, from 0.
    [[nodiscard]] std::vector<std::int64_t> offsets(const std::string& path, std::size_t count) const {
        std::vector<std::int64_t> result = indices(path, 0, count + 1);
        if (result.empty() || result.front() != 0 || result.back() != static_cast<std::int64_t>(count) ||
            !std::is_sorted(result.begin(), result.end()))
            contradiction(path);
        return result;
    }

    /// The arrays of a group that have `count` rows of one number or of three.
    void add_arrays(const std::string& group, std::size_t count, const Names& vmtk, PolyData& data) const {
        for (const ArchiveNode& node : nodes_) {
            if (node.is_group || !node.path.starts_with(group) || node.type == "string") continue;
            const std::string name = node.path.substr(group.size());
            const bool fits = !node.shape.empty() && node.shape[0] == count &&
                              (node.shape.size() == 1 || (node.shape.size() == 2 && node.shape[1] == 3));
            if (!fits || name.find('/') != std::string::npos || name == "points") continue;
            PolyDataArray array{name, node.shape.size() == 1 ? 1U : 3U, file_.numbers(node.path),
                                !node.type.starts_with("float")};
            for (const auto& [own, theirs] : vmtk)
                if (own == name)
                    data.point_arrays.push_back({theirs, array.components, array.values, array.is_integer});
            data.point_arrays.push_back(std::move(array));
        }
    }

    [[nodiscard]] const ArchiveNode* find(const std::string& path) const {
        const auto node = std::find_if(nodes_.begin(), nodes_.end(), [&](const auto& n) { return n.path == path; });
        return node == nodes_.end() ? nullptr : &*node;
    }

    [[noreturn]] void contradiction(const std::string& path) const {
        throw ArchiveError("cannot export '" + file_.file().string() + "': the values of " + path +
                           " do not fit the rest of the model");
    }

private:
    const ArchiveFile& file_;
    std::vector<ArchiveNode> nodes_;
};

PolyData surface_of(const Model& model) {
    PolyData data;
    data.points = model.numbers(names::kSurfacePoints.path);
    const std::size_t count = data.points.size() / 3;
    const auto corners = model.indices(names::kTriangles.path, 0, count);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
        data.polygons.add({corners[i], corners[i + 1], corners[i + 2]});
    model.add_arrays("/surface/", count,
                     {{"branch_id", "GroupIds"},
                      {"branch_abscissa", "AbscissaMetric"},
                      {"angle", "AngularMetric"},
                      {"euclidean_distance", "DistanceToCenterlines"}},
                     data);
    return data;
}

PolyData lines_of(const Model& model) {
    PolyData data;
    data.points = model.numbers(names::kLinePoints.path);
    const std::size_t count = data.points.size() / 3;
    const auto offsets = model.offsets(names::kLineOffsets.path, count);
    model.add_arrays("/centerlines/", count,
                     {{"radius", "MaximumInscribedSphereRadius"},
                      {"abscissa", "Abscissas"},
                      {"curvature", "Curvature"},
                      {"torsion", "Torsion"},
                      {"frame", "ParallelTransportNormals"}},
                     data);
    std::vector<std::int64_t> branch(count, 0), junction(count, -1);
    std::int64_t branches = 0;
    if (model.has("/centerlines/branch_id") && model.has("/centerlines/junction_id")) {
        constexpr auto kMost = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
        branch = model.indices("/centerlines/branch_id", -1, kMost);
        junction = model.indices("/centerlines/junction_id", -1, kMost);
        if (branch.size() != count || junction.size() != count) model.contradiction("/centerlines/branch_id");
        for (const std::int64_t b : branch) branches = std::max(branches, b + 1);
    } else {
        branches = static_cast<std::int64_t>(offsets.size()) - 1;
        for (std::size_t line = 0; line + 1 < offsets.size(); ++line)
            std::fill(branch.begin() + offsets[line], branch.begin() + offsets[line + 1],
                      static_cast<std::int64_t>(line));
    }
    PolyDataArray centerline{"CenterlineIds", 1, {}, true}, tract{"TractIds", 1, {}, true},
        group{"GroupIds", 1, {}, true}, blanking{"Blanking", 1, {}, true};
    for (std::size_t line = 0; line + 1 < offsets.size(); ++line) {
        const auto part_of = [&](std::int64_t k) {
            const auto at = static_cast<std::size_t>(k);
            return junction[at] >= 0 ? branches + junction[at] : branch[at];
        };
        double along = 0;
        for (std::int64_t first = offsets[line]; first < offsets[line + 1];) {
            std::int64_t end = first + 1;
            while (end < offsets[line + 1] && part_of(end) == part_of(first)) ++end;
            std::vector<std::int64_t> points;
            for (std::int64_t k = first; k < std::min(end + 1, offsets[line + 1]); ++k) points.push_back(k);
            if (points.size() > 1) {
                data.lines.add(points);
                centerline.values.push_back(static_cast<double>(line));
                tract.values.push_back(along++);
                group.values.push_back(static_cast<double>(part_of(first)));
                blanking.values.push_back(part_of(first) >= branches ? 1 : 0);
            }
            first = end;
        }
    }
    data.cell_arrays = {std::move(centerline), std::move(tract), std::move(group), std::move(blanking)};
    return data;
}

PolyData voronoi_of(const Model& model) {
    PolyData data;
    data.points = model.numbers(names::kVertices.path);
    const std::size_t count = data.points.size() / 3;
    const auto corners = model.indices(names::kPolygonVertices.path, 0, count);
    const auto offsets = model.offsets(names::kPolygonOffsets.path, corners.size());
    for (std::size_t p = 0; p + 1 < offsets.size(); ++p) {
        const std::vector<std::int64_t> polygon(corners.begin() + offsets[p], corners.begin() + offsets[p + 1]);
        (polygon.size() == 2 ? data.lines : data.polygons).add(polygon);
    }
    model.add_arrays("/voronoi/", count, {{"ball_radius", "MaximumInscribedSphereRadius"}}, data);
    if (model.has(names::kArrivalTime.path)) {
        std::vector<double> times = model.numbers(names::kArrivalTime.path);
        if (times.size() < count) model.contradiction(names::kArrivalTime.path);
        times.resize(count);
        data.point_arrays.push_back({"EikonalSolutionArray", 1, std::move(times), false});
    }
    return data;
}

}  // namespace

std::vector<std::filesystem::path> export_vtp(const ArchiveFile& file, const std::filesystem::path& directory) {
    const Model model(file);
    const std::string id = file.attribute("/", "id").value_or("");
    if (id.empty() || id.find('/') != std::string::npos)
        throw ArchiveError("cannot export '" + file.file().string() + "': its id is no file name");
    std::vector<std::filesystem::path> written;
    const auto write = [&](const names::Field& needed, const char* what, PolyData (*part)(const Model&)) {
        if (!model.has(needed.path)) return;
        written.push_back(directory / (id + "_" + what + ".vtp"));
        write_polydata(written.back(), part(model));
    };
    write(names::kSurfacePoints, "surface", surface_of);
    write(names::kLinePoints, "centerlines", lines_of);
    write(names::kVertices, "voronoi", voronoi_of);
    return written;
}

}  // namespace lumenline
