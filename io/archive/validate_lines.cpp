// Lines are held against their own points, the surface and the graph that was made of them.

#include <algorithm>
#include <cmath>

#include "engine/core/index_tables.h"
#include "engine/core/text.h"
#include "io/archive/branch_names.h"
#include "io/archive/inspection.h"
#include "io/archive/line_names.h"
#include "io/archive/model_tables.h"
#include "io/archive/packed_rows.h"

namespace lumenline {

namespace {

using Numbers = std::vector<double>;

constexpr double kRounding = 1e-9;  ///< of sums of lengths in double precision, relative

std::pair<std::size_t, std::size_t> part(const Numbers& offsets, std::size_t item) {
    return {static_cast<std::size_t>(offsets[item]), static_cast<std::size_t>(offsets[item + 1])};
}

/// Abscissae are the arc length of the points from the first of each part.
void check_arc_length(Inspection& inspection, const names::Field& points, const names::Field& offsets,
                      const names::Field& abscissa) {
    if (!inspection.are_sound({&points, &offsets, &abscissa})) return;
    const Numbers &xyz = inspection.numbers(points), &starts = inspection.numbers(offsets),
                  &along = inspection.numbers(abscissa);
    inspection.all_hold(abscissa.path, starts.size() - 1, [&](std::size_t line) {
        const auto [first, last] = part(starts, line);
        double length = 0;
        for (std::size_t k = first; k < last; ++k) {
            if (k > first) length += distance(point_at(xyz, k), point_at(xyz, k - 1));
            if (std::fabs(along[k] - length) > kRounding * std::max(length, along[last - 1]))
                return "part " + std::to_string(line) + " is " + short_text(length) + " long up to point " +
                       std::to_string(k) + ", where it says " + short_text(along[k]);
        }
        return std::string();
    });
}

double longest_edge(Inspection& inspection) {
    const Numbers &points = inspection.numbers(names::kSurfacePoints), &corners = inspection.numbers(names::kTriangles);
    double longest = 0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const std::size_t next = k % 3 == 2 ? k - 2 : k + 1;
        longest = std::max(longest, distance(point_at(points, static_cast<std::size_t>(corners[k])),
                                             point_at(points, static_cast<std::size_t>(corners[next]))));
    }
    return longest;
}

/// clearance^2 <= R^2 <= clearance^2 + (largest way from a point of a triangle to its nearest corner)^2
void check_balls(Inspection& inspection) {
    if (!inspection.are_sound(
            {&names::kLineBallRadius, &names::kClearance, &names::kSurfacePoints, &names::kTriangles}))
        return;
    const Numbers &ball = inspection.numbers(names::kLineBallRadius), &clear = inspection.numbers(names::kClearance);
    const double edge = longest_edge(inspection);
    inspection.all_hold(names::kLineBallRadius.path, ball.size(), [&](std::size_t k) {
        const double low = clear[k] * (1 - kRounding), high = std::hypot(clear[k], edge) * (1 + kRounding);
        if (ball[k] >= low && ball[k] <= high) return std::string();
        return "the ball of " + short_text(ball[k]) + " at point " + std::to_string(k) +
               " contradicts the distance to the wall, " + short_text(clear[k]);
    });
}

void check_ends(Inspection& inspection) {
    if (inspection.are_sound({&names::kLineTarget, &names::kLineLoop})) {
        const Numbers &target = inspection.numbers(names::kLineTarget), &loop = inspection.numbers(names::kLineLoop);
        inspection.all_hold(names::kLineTarget.path, target.size(), [&](std::size_t line) {
            return (target[line] < 0) == (loop[line] >= 0)
                       ? std::string()
                       : "line " + std::to_string(line) + " ends neither at an endpoint nor in a loop, or in both";
        });
    }
    if (inspection.are_sound({&names::kSources, &names::kEndpointRole})) {
        const std::vector<std::string> role = inspection.strings(names::kEndpointRole.path);
        const Numbers& sources = inspection.numbers(names::kSources);
        inspection.all_hold(names::kSources.path, sources.size(), [&](std::size_t s) {
            return role.at(static_cast<std::size_t>(sources[s])) == "inlet"
                       ? std::string()
                       : "the front at " + std::to_string(s) + " starts from an endpoint that is no inlet";
        });
    }
    if (inspection.is_sound(names::kEndpointRole.path)) {
        const std::vector<std::string> role = inspection.strings(names::kEndpointRole.path);
        inspection.all_hold(names::kEndpointRole.path, role.size(), [&](std::size_t e) {
            return e > 0 && role[e] == "inlet" && role[e - 1] != "inlet"
                       ? "the inlet " + std::to_string(e) + " stands behind an outlet"
                       : std::string();
        });
    }
}

/// The map from a path to its line ends where the line does.
void check_map(Inspection& inspection) {
    if (!inspection.are_sound({&names::kPathOffsets, &names::kLineAbscissa, &names::kLineOffsets, &names::kAbscissa}))
        return;
    const Numbers &paths = inspection.numbers(names::kPathOffsets), &lines = inspection.numbers(names::kLineOffsets),
                  &to = inspection.numbers(names::kLineAbscissa), &along = inspection.numbers(names::kAbscissa);
    inspection.all_hold(names::kLineAbscissa.path, paths.size() - 1, [&](std::size_t line) {
        const auto [first, last] = part(paths, line);
        const auto [line_first, line_last] = part(lines, line);
        if (first == last || line_first == line_last) return std::string();
        if (to[last - 1] <= along[line_last - 1] * (1 + kRounding)) return std::string();
        return "path " + std::to_string(line) + " leads beyond the end of its line";
    });
}

/// A column of a table holds the row's own number, or what another dataset says.
void check_equal(Inspection& inspection, const std::string& path, const Numbers& expected, const std::string& of) {
    if (!inspection.is_sound(path)) return;
    const Numbers& found = inspection.numbers(path);
    inspection.all_hold(path, std::min(found.size(), expected.size()), [&](std::size_t k) {
        return found[k] == expected[k]
                   ? std::string()
                   : "the value " + short_text(found[k]) + " at " + std::to_string(k) + " is not that of " + of;
    });
}

void check_graph(Inspection& inspection) {
    Numbers row;
    for (std::size_t k = 0; k < std::max(inspection.length('B'), inspection.length('X')); ++k)
        row.push_back(static_cast<double>(k));
    for (const char* path : {"/branches/branch_id", "/stenoses/branch_id", "/dilations/branch_id"})
        check_equal(inspection, path, row, "its row");
    check_equal(inspection, "/bifurcations/junction_id", row, "its row");
    if (inspection.is_sound(names::kEdges.path)) {
        Numbers first, last;
        const Numbers& edges = inspection.numbers(names::kEdges);
        for (std::size_t k = 0; k + 1 < edges.size(); k += 2) {
            first.push_back(edges[k]);
            last.push_back(edges[k + 1]);
        }
        check_equal(inspection, "/branches/first_node", first, "/graph/edges");
        check_equal(inspection, "/branches/last_node", last, "/graph/edges");
    }
    if (inspection.are_sound({&names::kNodeKind, &names::kNodeJunction})) {
        const std::vector<std::string> kind = inspection.strings(names::kNodeKind.path);
        const Numbers& junction = inspection.numbers(names::kNodeJunction);
        inspection.all_hold(names::kNodeJunction.path, kind.size(), [&](std::size_t n) {
            return (kind[n] == "junction") == (junction[n] >= 0)
                       ? std::string()
                       : "node " + std::to_string(n) + " is of kind " + kind[n] + " and has the junction " +
                             short_text(junction[n]);
        });
    }
    if (inspection.are_sound({&names::kSiteBranch, &names::kCenterlineId})) {
        const Numbers &branch = inspection.numbers(names::kSiteBranch),
                      &line = inspection.numbers(names::kCenterlineId);
        inspection.all_hold(names::kSiteBranch.path, branch.size(), [&](std::size_t s) {
            return (branch[s] < 0) == (line[s] < 0) ? std::string()
                                                    : "site " + std::to_string(s) +
                                                          " has a branch without a centerline, or a centerline "
                                                          "without a branch";
        });
    }
}

/// Can the column be compared: is all that it is read from as specified?
bool is_sound_column(const Inspection& inspection, const Table& table, const Column& column) {
    if (std::string_view(table.name) != "endpoints")
        return inspection.is_sound("/" + std::string(table.name) + "/" + column.name);
    const bool has_graph = inspection.file().has(names::kEdges.path);
    return inspection.are_sound(
               {&names::kEndpointRole, &names::kEndpointKind, &names::kEndpointPoint, &names::kEndpointRadius}) &&
           (!has_graph || inspection.are_sound({&names::kEdges, &names::kNodeEndpoint}));
}

/// The copy of the rows says what the columns say.
void check_index_rows(Inspection& inspection) {
    const char* const path = names::kIndexRows.path;
    if (!inspection.is_sound(path)) return;
    std::vector<Table> packed = index_tables(Branches(), Endpoints()), read;
    try {
        if (!hdf::unpack_rows(inspection.file().bytes(path), packed))
            return inspection.report(path, "its sum is not that of its bytes");
        read = hdf::read_columns_of_index_tables(inspection.file());
    } catch (const ArchiveError&) {
        return;  // what cannot be read was reported with the columns
    }
    for (std::size_t t = 0; t < packed.size(); ++t)
        for (std::size_t c = 0; c < packed[t].columns.size(); ++c) {
            const Column &copy = packed[t].columns[c], &column = read[t].columns[c];
            if (is_sound_column(inspection, read[t], column) &&
                (copy.texts != column.texts || !std::equal(copy.numbers.begin(), copy.numbers.end(),
                                                           column.numbers.begin(), column.numbers.end(), same_number)))
                return inspection.report(path, "it differs from the column " + column.name + " of /" + read[t].name);
        }
}

}  // namespace

void check_lines(Inspection& inspection) {
    check_arc_length(inspection, names::kLinePoints, names::kLineOffsets, names::kAbscissa);
    check_arc_length(inspection, names::kPathPoints, names::kPathOffsets, names::kPathAbscissa);
    check_balls(inspection);
    check_ends(inspection);
    check_map(inspection);
    check_graph(inspection);
    check_index_rows(inspection);
}

}  // namespace lumenline
