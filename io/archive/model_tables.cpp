#include "io/archive/model_tables.h"

#include <algorithm>

#include "engine/core/index_tables.h"
#include "io/archive/branch_names.h"
#include "io/archive/line_names.h"
#include "io/archive/packed_rows.h"
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

std::vector<Table> read_columns_of_index_tables(const ArchiveFile& file) {
    const Endpoints ends = file.has(names::kEndpointRole.path) ? read_endpoints(file) : Endpoints();
    std::vector<Table> tables = index_tables(Branches(), ends);
    for (std::size_t t = 0; t + 1 < tables.size(); ++t) read_table(file, group_of(tables[t]), tables[t]);
    read_branches_of_ends(file, tables.back());
    return tables;
}

std::vector<Table> read_index_tables(const ArchiveFile& file) {
    if (file.has(names::kIndexRows.path)) {
        std::vector<Table> tables = index_tables(Branches(), Endpoints());
        if (unpack_rows(file.bytes(names::kIndexRows.path), tables)) return tables;
    }
    return read_columns_of_index_tables(file);
}

}  // namespace lumenline::hdf
