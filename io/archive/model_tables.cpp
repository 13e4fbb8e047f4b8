#include "io/archive/model_tables.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "engine/core/index_tables.h"
#include "io/archive/branch_names.h"
#include "io/archive/line_names.h"
#include "io/archive/tables.h"

namespace lumenline::hdf {

namespace {

[[noreturn]] void damaged(const ArchiveFile& file, const std::string& reason) {
    throw ArchiveError("cannot use '" + file.file().string() + "': " + reason);
}

std::string group_of(const Table& table) { return std::string("/") + table.name; }

/// Which branch starts or ends at each endpoint.
void read_branches_of_ends(const ArchiveFile& file, Table& table) {
    if (!file.has(names::kEdges.path)) return;
    const auto column =
        std::find_if(table.columns.begin(), table.columns.end(), [](const Column& c) { return c.name == "branch_id"; });
    const std::vector<double> endpoints = file.numbers(names::kNodeEndpoint.path);
    const std::vector<double> edges = file.numbers(names::kEdges.path);
    for (std::size_t k = 0; k < edges.size(); ++k) {
        if (!(edges[k] >= 0 && edges[k] < static_cast<double>(endpoints.size())))
            damaged(file, "/graph/edges name nodes that do not exist");
        const double endpoint = endpoints[static_cast<std::size_t>(edges[k])];
        if (endpoint >= 0 && endpoint < static_cast<double>(column->numbers.size()))
            column->numbers[static_cast<std::size_t>(endpoint)] = static_cast<double>(k / 2);
    }
}

std::size_t longest(const std::vector<std::string>& texts) {
    std::size_t length = 0;
    for (const std::string& text : texts) length = std::max(length, text.size());
    return length;
}

std::size_t rows_of_table(const ArchiveFile& file, const Table& table) {
    if (!file.has(group_of(table))) return 0;
    for (const Column& column : table.columns)
        if (const std::string path = group_of(table) + "/" + column.name; file.has(path)) {
            const std::vector<std::uint64_t> shape = file.shape(path);
            if (shape.size() != 1) damaged(file, path + " has rows of several numbers");
            return shape[0];
        }
    return 0;
}

}  // namespace

Endpoints read_endpoints(const ArchiveFile& file) {
    Endpoints endpoints;
    const std::vector<std::string> roles = file.strings(names::kEndpointRole.path);
    const std::vector<std::string> kinds = file.strings(names::kEndpointKind.path);
    const std::vector<double> points = file.numbers(names::kEndpointPoint.path);
    const std::vector<double> radii = file.numbers(names::kEndpointRadius.path);
    if (kinds.size() != roles.size() || points.size() != 3 * roles.size() || radii.size() != roles.size())
        damaged(file, "the arrays of /endpoints are not of matching length");
    for (std::size_t e = 0; e < roles.size(); ++e) {
        Endpoint endpoint;
        endpoint.role = roles[e] == role_name(EndpointRole::kInlet) ? EndpointRole::kInlet : EndpointRole::kOutlet;
        if (role_name(endpoint.role) != roles[e]) damaged(file, "'" + roles[e] + "' is no role of an endpoint");
        for (const EndpointKind kind :
             {EndpointKind::kBoundary, EndpointKind::kPoint, EndpointKind::kTip, EndpointKind::kCap})
            if (kind_name(kind) == kinds[e]) endpoint.kind = kind;
        if (kind_name(endpoint.kind) != kinds[e]) damaged(file, "'" + kinds[e] + "' is no kind of an endpoint");
        endpoint.point = {points[3 * e], points[3 * e + 1], points[3 * e + 2]};
        endpoint.radius = radii[e];
        endpoints.push_back(endpoint);
    }
    return endpoints;
}

std::vector<Table> read_index_tables(const ArchiveFile& file) {
    const Endpoints ends = file.has(names::kEndpointRole.path) ? read_endpoints(file) : Endpoints();
    std::vector<Table> tables = index_tables(Branches(), ends);
    for (std::size_t t = 0; t + 1 < tables.size(); ++t) read_table(file, group_of(tables[t]), tables[t]);
    read_branches_of_ends(file, tables.back());
    return tables;
}

TableOutline read_outline(const ArchiveFile& file) {
    TableOutline outline;
    std::vector<Table> tables = index_tables(Branches(), Endpoints());
    for (std::size_t t = 0; t + 1 < tables.size(); ++t) outline.rows.push_back(rows_of_table(file, tables[t]));
    outline.rows.push_back(0);
    if (file.has(names::kEndpointRole.path)) {
        const std::vector<std::string> roles = file.strings(names::kEndpointRole.path);
        outline.rows.back() = roles.size();
        outline.role_width = longest(roles);
        outline.kind_width = longest(file.strings(names::kEndpointKind.path));
    }
    constexpr std::array<std::string_view, 8> kOfTree{"parent", "length",      "radius_mean", "order_margin",
                                                      "chord",  "direction_x", "direction_y", "direction_z"};
    Table& branches = tables.front();
    std::erase_if(branches.columns,
                  [&](const Column& c) { return std::find(kOfTree.begin(), kOfTree.end(), c.name) == kOfTree.end(); });
    if (outline.rows.front() > 0 && read_table(file, group_of(branches), branches))
        outline.tree = branch_tree(branches);
    return outline;
}

}  // namespace lumenline::hdf
