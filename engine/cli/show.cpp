// Everything printed comes from a file that may be anybody's: text goes through `printable`, and indices and offsets
// are held against the arrays they point into before they are used.

#include "engine/cli/show.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

#include "engine/cli/sparkline.h"
#include "engine/cli/table.h"
#include "engine/core/text.h"
#include "io/archive/branch_names.h"
#include "io/archive/line_names.h"
#include "io/archive/names.h"
#include "io/archive/utf8.h"

namespace lumenline {

namespace {

using enum TextTable::Align;

constexpr std::size_t kSparkCells = 32;

TextTable table_of(std::initializer_list<const char*> left, std::initializer_list<const char*> right) {
    TextTable table;
    for (const char* heading : left) table.add_column(heading, kLeft);
    for (const char* heading : right) table.add_column(heading, kRight);
    return table;
}

void require_rows(const ArchiveFile& file, const names::Field& field, std::size_t count, std::size_t expected) {
    if (count != expected)
        throw ArchiveError("cannot use '" + file.file().string() + "': " + field.path + " has " +
                           std::to_string(count) + " values, " + std::to_string(expected) + " were expected");
}

std::vector<double> numbers(const ArchiveFile& file, const names::Field& field, std::size_t expected) {
    std::vector<double> values = file.numbers(field.path);
    require_rows(file, field, values.size(), expected);
    return values;
}

std::vector<std::string> strings(const ArchiveFile& file, const names::Field& field, std::size_t expected) {
    std::vector<std::string> values = file.strings(field.path);
    require_rows(file, field, values.size(), expected);
    return values;
}

std::string point_text(const std::vector<double>& xyz, std::size_t row) {
    return short_text(Vec3{xyz[3 * row], xyz[3 * row + 1], xyz[3 * row + 2]});
}

void show_endpoints(const ArchiveFile& file, std::ostream& out) {
    if (!file.has(names::kEndpointRole.path)) return;
    const std::vector<std::string> role = file.strings(names::kEndpointRole.path);
    const auto kind = strings(file, names::kEndpointKind, role.size());
    const auto point = numbers(file, names::kEndpointPoint, 3 * role.size());
    const auto normal = numbers(file, names::kEndpointNormal, 3 * role.size());
    const auto radius = numbers(file, names::kEndpointRadius, role.size());
    out << "\nendpoints\n";
    TextTable table = table_of({"index", "role", "kind", "point", "normal"}, {"radius"});
    for (std::size_t e = 0; e < role.size(); ++e)
        table.add_row({std::to_string(e), role[e], kind[e], point_text(point, e), point_text(normal, e),
                       table_number(radius[e])});
    table.print(out);
}

/// The part of a ragged array that `item` is. @throws ArchiveError where offsets do not ascend within `count` values
struct Part {
    std::size_t first, last;
};
Part part_of(const ArchiveFile& file, const names::Field& field, const std::vector<double>& offsets, std::size_t item,
             std::size_t count) {
    if (!(offsets[item] >= 0 && offsets[item] <= offsets[item + 1] && offsets[item + 1] <= static_cast<double>(count)))
        throw ArchiveError("cannot use '" + file.file().string() + "': " + field.path +
                           " do not ascend within the points");
    return {static_cast<std::size_t>(offsets[item]), static_cast<std::size_t>(offsets[item + 1])};
}

void show_lines(const ArchiveFile& file, std::ostream& out) {
    if (!file.has(names::kLineOffsets.path)) return;
    const std::vector<double> source = file.numbers(names::kLineSource.path);
    const auto target = numbers(file, names::kLineTarget, source.size());
    const auto offsets = numbers(file, names::kLineOffsets, source.size() + 1);
    const std::vector<double> radius = file.numbers(names::kRadius.path);
    const auto abscissa = numbers(file, names::kAbscissa, radius.size());
    out << "\nlines\n";
    TextTable table = table_of({}, {"index", "source", "target", "points", "length", "radius_min", "radius_max"});
    for (std::size_t line = 0; line < source.size(); ++line) {
        const auto [first, last] = part_of(file, names::kLineOffsets, offsets, line, radius.size());
        std::vector<std::string> row{std::to_string(line), short_text(source[line]), short_text(target[line]),
                                     std::to_string(last - first)};
        if (first == last) {
            row.insert(row.end(), {"-", "-", "-"});
        } else {
            const auto at_point = [&](std::size_t k) { return radius.begin() + static_cast<std::ptrdiff_t>(k); };
            const auto [low, high] = std::minmax_element(at_point(first), at_point(last));
            row.insert(row.end(),
                       {table_number(abscissa[last - 1] - abscissa[first]), table_number(*low), table_number(*high)});
        }
        table.add_row(row);
    }
    table.print(out);
}

struct Place {
    double abscissa, radius;
    std::size_t point;
};

/// The points of all lines by their branch, along it.
std::vector<std::vector<Place>> places_by_branch(const ArchiveFile& file, std::size_t branches) {
    const std::vector<double> radius = file.numbers(names::kRadius.path);
    const auto branch = numbers(file, names::kLineBranch, radius.size());
    const auto abscissa = numbers(file, names::kLineBranchAbscissa, radius.size());
    std::vector<std::vector<Place>> places(branches);
    for (std::size_t k = 0; k < radius.size(); ++k) {
        if (!(branch[k] >= 0 && branch[k] < static_cast<double>(branches)))
            throw ArchiveError("cannot use '" + file.file().string() + "': " + names::kLineBranch.path +
                               " names a branch that is none");
        if (std::isfinite(radius[k]) && std::isfinite(abscissa[k]))
            places[static_cast<std::size_t>(branch[k])].push_back({abscissa[k], radius[k], k});
    }
    for (std::vector<Place>& own : places)
        std::sort(own.begin(), own.end(), [](const Place& a, const Place& b) {
            return std::tie(a.abscissa, a.point) < std::tie(b.abscissa, b.point);
        });
    return places;
}

/// The radius along each branch, with its narrowest place.
void show_branches(const ArchiveFile& file, std::ostream& out) {
    if (!file.has(names::kAxisOffsets.path) || !file.has(names::kLineBranch.path)) return;
    const std::size_t branches = std::max<std::size_t>(file.numbers(names::kAxisOffsets.path).size(), 1) - 1;
    const std::vector<std::vector<Place>> places = places_by_branch(file, branches);
    const auto point = numbers(file, names::kLinePoints, 3 * file.numbers(names::kRadius.path).size());
    out << "\nradius along each branch, drawn from 0 to its largest\n";
    TextTable table = table_of({}, {"branch", "length", "radius_min", "radius_max", "narrowest_at"});
    table.add_column("narrowest_point", kLeft);
    table.add_column("radius", kLeft);
    const SparkSet set = spark_set();
    for (std::size_t b = 0; b < branches; ++b) {
        const std::vector<Place>& own = places[b];
        if (own.empty()) {
            table.add_row({std::to_string(b), "-", "-", "-", "-", "-", ""});
            continue;
        }
        std::vector<double> at, radius;
        for (const Place& place : own) {
            at.push_back(place.abscissa);
            radius.push_back(place.radius);
        }
        const auto [low, high] = std::minmax_element(radius.begin(), radius.end());
        const Place& narrowest = own[static_cast<std::size_t>(low - radius.begin())];
        table.add_row({std::to_string(b), table_number(at.back() - at.front()), table_number(*low), table_number(*high),
                       table_number(narrowest.abscissa), point_text(point, narrowest.point),
                       sparkline(at, radius, kSparkCells, set)});
    }
    table.print(out);
}

void show_character(const ArchiveFile& file, std::ostream& out) {
    if (!file.has(names::kStatisticsGeodesic.path)) return;
    const auto sites = numbers(file, names::kWallSites, 1), unreached = numbers(file, names::kUnreachedSites, 1);
    out << "\ncharacterization of " << exact_text(sites[0] - unreached[0]) << " of " << exact_text(sites[0])
        << " sites of the wall\n";
    TextTable table = table_of({"quantity"}, {"mean", "sd", "median", "p95"});
    for (const auto& [name, field] : {std::pair("geodesic distance D_g", &names::kStatisticsGeodesic),
                                      std::pair("euclidean distance D_e", &names::kStatisticsEuclidean),
                                      std::pair("tangency deviation NTD", &names::kStatisticsTangency)}) {
        const auto v = numbers(file, *field, 4);
        table.add_row({name, table_number(v[0]), table_number(v[1]), table_number(v[2]), table_number(v[3])});
    }
    table.print(out);
    const auto jumps = numbers(file, names::kJumps, 3);
    out << "jumps along edges: " << jumps[0] << " pole changes sheet, " << jumps[1] << " branches meet, " << jumps[2]
        << " other\n";
}

void show_diagnostics(const ArchiveFile& file, std::ostream& out) {
    const std::vector<std::string> code = file.strings(names::kCode.path);
    if (code.empty()) return;
    const auto severity = strings(file, names::kSeverity, code.size());
    const auto stage = strings(file, names::kStage, code.size());
    const auto message = strings(file, names::kMessage, code.size());
    const auto value = numbers(file, names::kValue, code.size());
    const auto limit = numbers(file, names::kLimit, code.size());
    out << "\ndiagnostics\n";
    TextTable table = table_of({"severity", "stage", "code"}, {"value", "limit"});
    table.add_column("message", kLeft);
    for (std::size_t i = 0; i < code.size(); ++i)
        table.add_row({severity[i], stage[i], code[i], table_number(value[i]), table_number(limit[i]), message[i]});
    table.print(out);
}

}  // namespace

void show_model(const ArchiveFile& file, std::ostream& out) {
    TextTable table = table_of({"attribute", "value"}, {});
    for (const auto& [name, value] : file.attributes("/"))
        if (!value.empty() && name != "failure_sentence") table.add_row({name, value});
    table.print(out);
    if (const auto sentence = file.attribute("/", "failure_sentence"); sentence)
        out << "\nfailed: " << printable(*sentence) << '\n';
    show_endpoints(file, out);
    show_lines(file, out);
    show_branches(file, out);
    show_character(file, out);
    show_diagnostics(file, out);
}

}  // namespace lumenline
