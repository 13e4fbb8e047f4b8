// Everything printed comes from a file that may be anybody's: text goes through `printable`, and
// endpoint indices are checked against the endpoints before they are used.

#include "engine/cli/browse.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "engine/cli/serve.h"
#include "engine/cli/standard_output.h"
#include "engine/cli/table.h"
#include "engine/core/text.h"
#include "io/archive/line_names.h"
#include "io/archive/names.h"
#include "io/archive/read.h"
#include "io/archive/utf8.h"

namespace lumenline {

namespace {

constexpr int kDone = 0;
constexpr int kDamaged = 1;
constexpr int kUsage = 2;

using enum TextTable::Align;

struct Request {
    enum class What { kList, kShow, kGet, kTree, kServe, kPage };
    What what = What::kList;
    std::string archive, id, path, output;
    ServeOptions serve;
    PageOptions page;
};

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
        if (!(offsets[line] >= 0 && offsets[line] <= offsets[line + 1] &&
              offsets[line + 1] <= static_cast<double>(radius.size())))
            throw ArchiveError("cannot use '" + file.file().string() +
                               "': /centerlines/offsets do not ascend within the points");
        const auto first = static_cast<std::size_t>(offsets[line]);
        const auto last = static_cast<std::size_t>(offsets[line + 1]);
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

void show_character(const ArchiveFile& file, std::ostream& out) {
    if (!file.has(names::kStatisticsGeodesic.path)) return;
    const auto sites = numbers(file, names::kWallSites, 1), unreached = numbers(file, names::kUnreachedSites, 1);
    out << "\ncharacterization of " << table_number(sites[0] - unreached[0]) << " of " << table_number(sites[0])
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

void show(const ArchiveFile& file, std::ostream& out) {
    TextTable table = table_of({"attribute", "value"}, {});
    for (const auto& [name, value] : file.attributes("/"))
        if (!value.empty() && name != "failure_sentence") table.add_row({name, value});
    table.print(out);
    if (const auto sentence = file.attribute("/", "failure_sentence"); sentence)
        out << "\nfailed: " << printable(*sentence) << '\n';
    show_endpoints(file, out);
    show_lines(file, out);
    show_character(file, out);
    show_diagnostics(file, out);
}

void print_tree(const ArchiveFile& file, std::ostream& out) {
    TextTable table = table_of({"path", "type", "shape", "units", "description"}, {});
    for (const ArchiveNode& node : file.nodes()) {
        if (node.is_group)
            table.add_row({node.path, "group", "", "", ""});
        else
            table.add_row({node.path, node.type, shape_text(node.shape), node.units, node.description});
    }
    table.print(out);
}

void browse(const Request& request, std::ostream& out) {
    using What = Request::What;
    if (request.what == What::kPage) return write_page(request.archive, request.output, request.page);
    if (request.what == What::kServe)
        return serve_archive(request.archive, request.serve, [&](const std::string& address) {
            out << address << std::endl;
            std::cerr << "Open this address in a browser; Ctrl-C ends the server.\n";
        });
    if (request.what == What::kList) {
        print_models(out, list_models(request.archive));
        return;
    }
    const ArchiveFile file = open_model(request.archive, request.id);
    if (request.what == What::kShow) show(file, out);
    if (request.what == What::kTree) print_tree(file, out);
    if (request.what == What::kGet) file.print(request.path, out);
}

int run(const Request& request) {
    const auto say = [](const std::exception& error) { std::cerr << "lumenline: " << printable(error.what()) << '\n'; };
    try {
        to_standard_output([&](std::ostream& out) { browse(request, out); });
        return kDone;
    } catch (const UnknownName& error) {
        say(error);
        return kUsage;
    } catch (const std::exception& error) {
        say(error);
        return kDamaged;
    }
}

}  // namespace

void add_browse(CLI::App& app, std::function<int()>& action) {
    using What = Request::What;
    const auto request = std::make_shared<Request>();
    CLI::App* verb = app.add_subcommand("browse", "Print what an archive holds");
    verb->add_option("ARCHIVE", request->archive, "directory with a cohort.h5, or one model file")->required();
    verb->require_subcommand(0, 1);
    verb->callback([request, &action] { action = [request] { return run(*request); }; });

    const auto add_verb = [&](const char* name, const char* help, What what) {
        CLI::App* part = verb->add_subcommand(name, help);
        part->callback([request, what] { request->what = what; });
        return part;
    };
    const auto add = [&](const char* name, const char* help, What what) {
        CLI::App* part = add_verb(name, help, what);
        part->add_option("ID", request->id, "model")->required();
        return part;
    };
    add_verb("list", "table of the models (default)", What::kList);
    add("show", "attributes, endpoints, lines, characterization and diagnostics of one model", What::kShow);
    add("tree", "groups and datasets of one model", What::kTree);
    add("get", "one dataset, or attribute PATH@name, as tab-separated text", What::kGet)
        ->add_option("PATH", request->path, "dataset, as 'tree' names it")
        ->required();

    add_verb("serve", "show the archive in a browser: table and plots of the cohort, every model in 3D", What::kServe)
        ->add_option("--port", request->serve.port, "of 127.0.0.1; 0 = 8417, or any free one if that is taken")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    CLI::App* page = add_verb("page", "the same as one HTML file with the archive in it", What::kPage);
    page->add_option("-o,--output", request->output, "file to write")->required();
    page->add_option("--model", request->page.models, "only this model comes along; may be repeated");
    page->add_flag("--empty", request->page.empty, "no archive in it: the page asks for one");
}

}  // namespace lumenline
