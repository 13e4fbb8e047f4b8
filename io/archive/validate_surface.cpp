// A closed oriented manifold has each directed edge once, with its reverse, and one cycle of triangles around each
// vertex. Its handles follow from Euler's formula.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "engine/core/text.h"
#include "io/archive/inspection.h"
#include "io/archive/line_names.h"

namespace lumenline {

namespace {

using Numbers = std::vector<double>;

std::size_t root_of(std::vector<std::size_t>& parent, std::size_t site) {
    while (parent[site] != site) site = parent[site] = parent[parent[site]];
    return site;
}

void check_manifold(Inspection& inspection, const Numbers& triangles) {
    struct Edge {
        std::uint64_t from, to;
        bool operator<(const Edge& other) const { return std::pair(from, to) < std::pair(other.from, other.to); }
        bool operator==(const Edge& other) const { return from == other.from && to == other.to; }
    };
    const std::size_t count = triangles.size() / 3;
    std::vector<Edge> edges;
    edges.reserve(triangles.size());
    for (std::size_t t = 0; t < count; ++t)
        for (std::size_t k = 0; k < 3; ++k)
            edges.push_back({static_cast<std::uint64_t>(triangles[3 * t + k]),
                             static_cast<std::uint64_t>(triangles[3 * t + (k + 1) % 3])});
    std::sort(edges.begin(), edges.end());
    const auto name = [&](std::size_t k) {
        return "the edge from site " + std::to_string(edges[k].from) + " to " + std::to_string(edges[k].to);
    };
    const auto all_edges = [&](const char* wrong, auto is_wrong) {
        if (!inspection.is_sound(names::kTriangles.path)) return;
        inspection.all_hold(names::kTriangles.path, edges.size(),
                            [&](std::size_t k) { return is_wrong(k) ? name(k) + wrong : std::string(); });
    };
    all_edges(" has one end", [&](std::size_t k) { return edges[k].from == edges[k].to; });
    all_edges(" belongs to two triangles of one direction",
              [&](std::size_t k) { return k > 0 && edges[k - 1] == edges[k]; });
    all_edges(" has no triangle on its other side", [&](std::size_t k) {
        return !std::binary_search(edges.begin(), edges.end(), Edge{edges[k].to, edges[k].from});
    });
}

double number_of(Inspection& inspection, const char* name) {
    const std::string text = inspection.file().attribute(names::kSurface, name).value_or("");
    double value = std::numeric_limits<double>::quiet_NaN();
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

void check_genus(Inspection& inspection, const Numbers& triangles) {
    const std::size_t sites = inspection.length('N');
    std::vector<std::size_t> parent(sites);
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    std::vector<bool> used(sites, false);
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        const auto a = static_cast<std::size_t>(triangles[k]), b = static_cast<std::size_t>(triangles[k / 3 * 3]);
        used[a] = true;
        parent[root_of(parent, a)] = root_of(parent, b);
    }
    std::size_t components = 0, corners = 0;
    for (std::size_t s = 0; s < sites; ++s) {
        components += used[s] && root_of(parent, s) == s ? 1 : 0;
        corners += used[s] ? 1 : 0;
    }
    const auto place = [](const char* name) { return std::string(names::kSurface) + "@" + name; };
    const double stated = number_of(inspection, "component_count"), genus = number_of(inspection, "genus");
    if (stated != static_cast<double>(components))
        inspection.report(place("component_count"),
                          "is " + short_text(stated) + ", but the triangles form " + counted(components, "component"));
    // V - E + F = 2 components - 2 genus, with E = 3F/2.
    const double euler = static_cast<double>(corners) - static_cast<double>(triangles.size() / 3) / 2;
    const double handles = static_cast<double>(components) - euler / 2;
    if (genus != handles)
        inspection.report(place("genus"),
                          "is " + short_text(genus) + ", but the triangles have " + short_text(handles) + " handles");
    if (!(number_of(inspection, "diagonal") > 0)) inspection.report(place("diagonal"), "is no positive number");
}

/// Counts that /characterization states of the sites of zone 0.
void check_counts(Inspection& inspection) {
    if (!inspection.are_sound({&names::kZone, &names::kGeodesic, &names::kWallSites, &names::kUnreachedSites})) return;
    const Numbers &zone = inspection.numbers(names::kZone), &distance = inspection.numbers(names::kGeodesic);
    double wall = 0, unreached = 0;
    for (std::size_t s = 0; s < zone.size(); ++s) {
        if (zone[s] != 0) continue;
        ++wall;
        if (std::isnan(distance[s])) ++unreached;
    }
    for (const auto& [field, expected, what] :
         {std::tuple(&names::kWallSites, wall, " sites have zone 0"),
          std::tuple(&names::kUnreachedSites, unreached, " of the sites of zone 0 have no geodesic distance")})
        if (const double stated = inspection.numbers(*field).front(); stated != expected)
            inspection.report(field->path, "is " + short_text(stated, 10) + ", but " + short_text(expected, 10) + what);
}

/// Reports a copy that differs from what it is a copy of.
void check_copy(Inspection& inspection, const names::Field& field, const Numbers& expected, const char* of) {
    if (!inspection.is_sound(field.path)) return;
    const Numbers& found = inspection.numbers(field);
    inspection.all_hold(field.path, expected.size(), [&](std::size_t k) {
        return k < found.size() && same_number(found[k], expected[k])
                   ? std::string()
                   : "the value at " + std::to_string(k) + " is not that of " + of;
    });
}

void check_vtk(Inspection& inspection) {
    if (!inspection.are_sound({&names::kSurfacePoints, &names::kTriangles})) return;
    const bool has_lines = inspection.file().has(names::kCenterlines);
    if (has_lines && !inspection.are_sound({&names::kLinePoints, &names::kLineOffsets, &names::kRadius})) return;
    const std::size_t sites = inspection.length('N'), triangles = inspection.length('M'),
                      k_points = inspection.length('K');
    Numbers points = inspection.numbers(names::kSurfacePoints), cells = inspection.numbers(names::kTriangles);
    Numbers ends, types(triangles, 5), radius(sites, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t t = 0; t <= triangles; ++t) ends.push_back(static_cast<double>(3 * t));
    if (has_lines) {
        const Numbers &line_points = inspection.numbers(names::kLinePoints), &own = inspection.numbers(names::kRadius);
        points.insert(points.end(), line_points.begin(), line_points.end());
        radius.insert(radius.end(), own.begin(), own.end());
        for (std::size_t k = 0; k < k_points; ++k) cells.push_back(static_cast<double>(sites + k));
        const Numbers& offsets = inspection.numbers(names::kLineOffsets);
        for (std::size_t line = 1; line < offsets.size(); ++line)
            ends.push_back(static_cast<double>(3 * triangles) + offsets[line]);
        types.resize(triangles + offsets.size() - 1, 4);
    }
    check_copy(inspection, names::kVtkPointCount, {static_cast<double>(points.size() / 3)}, "the points");
    check_copy(inspection, names::kVtkCellCount, {static_cast<double>(types.size())}, "triangles and centerlines");
    check_copy(inspection, names::kVtkIdCount, {static_cast<double>(cells.size())}, "Connectivity");
    check_copy(inspection, names::kVtkPoints, points, "/surface/points and /centerlines/points");
    check_copy(inspection, names::kVtkConnectivity, cells, "/surface/triangles and the lines");
    check_copy(inspection, names::kVtkOffsets, ends, "the cells");
    check_copy(inspection, names::kVtkTypes, types, "triangles and centerlines");
    check_copy(inspection, names::kVtkRadius, radius, "/centerlines/radius");
    if (!inspection.are_sound({&names::kCap})) return;
    Numbers part;
    for (const double cap : inspection.numbers(names::kCap)) part.push_back(cap == -1 ? 0 : 1);
    part.resize(types.size(), 2);
    check_copy(inspection, names::kVtkPart, part, "/surface/cap and the lines");
}

}  // namespace

void check_surface(Inspection& inspection) {
    if (inspection.are_sound({&names::kSurfacePoints, &names::kTriangles})) {
        const Numbers& triangles = inspection.numbers(names::kTriangles);
        check_manifold(inspection, triangles);
        if (inspection.is_sound(names::kTriangles.path)) check_genus(inspection, triangles);
    }
    check_counts(inspection);
    check_vtk(inspection);
}

}  // namespace lumenline
