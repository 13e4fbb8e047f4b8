#include "engine/cli/browse.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "engine/cli/list.h"
#include "engine/cli/run.h"
#include "engine/cli/serve.h"
#include "engine/cli/show.h"
#include "engine/cli/standard_output.h"
#include "engine/cli/table.h"
#include "io/archive/commit.h"
#include "io/archive/read.h"

namespace lumenline {

namespace {

struct Request {
    enum class What { kList, kShow, kGet, kTree, kServe, kPage };
    What what = What::kList;
    std::string archive, id, path, output;
    ListOptions list;
    ServeOptions serve;
    PageOptions page;
};

void print_tree(const ArchiveFile& file, std::ostream& out) {
    TextTable table;
    for (const char* heading : {"path", "type", "shape", "units", "description"})
        table.add_column(heading, TextTable::Align::kLeft);
    for (const ArchiveNode& node : file.nodes()) {
        if (node.is_group)
            table.add_row({node.path, "group", "", "", ""});
        else
            table.add_row({node.path, node.type, shape_text(node.shape), node.units, node.description});
    }
    table.print(out);
}

void get(const ArchiveFile& file, const Request& request, std::ostream& out) {
    if (request.output.empty()) return file.print(request.path, out);
    refuse_overwriting(request.output, request.archive);
    std::string extension = std::filesystem::path(request.output).extension().string();
    for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const bool is_npy = extension == ".npy";
    write_file(request.output, [&](std::ostream& stream) {
        is_npy ? file.save_npy(request.path, stream) : file.print(request.path, stream);
    });
}

void browse(const Request& request, std::ostream& out) {
    using What = Request::What;
    if (request.what == What::kPage) return write_page(request.archive, request.output, request.page);
    if (request.what == What::kServe)
        return serve_archive(request.archive, request.serve, [&](const std::string& address) {
            out << address << std::endl;
            std::cerr << "Open this address in a browser; Ctrl-C ends the server.\n";
        });
    if (request.what == What::kList) return print_list(request.archive, request.list, out);
    const ArchiveFile file = open_model(request.archive, request.id);
    if (request.what == What::kShow) show_model(file, out);
    if (request.what == What::kTree) print_tree(file, out);
    if (request.what == What::kGet) get(file, request, out);
}

int run(const Request& request) {
    to_standard_output([&](std::ostream& out) { browse(request, out); });
    return kDone;
}

}  // namespace

void add_browse(CLI::App& app, std::function<int()>& action) {
    using What = Request::What;
    const auto request = std::make_shared<Request>();
    CLI::App* verb = app.add_subcommand("browse", "Print what an archive holds");
    verb->add_option("ARCHIVE", request->archive, "directory with a cohort.h5, a packed archive, or one model file")
        ->required();
    verb->require_subcommand(0, 1);
    verb->footer(
        "Exit status: 0 done, 1 the archive is damaged or the output cannot be written, 2 no such archive, model, "
        "dataset\n"
        "or column.");
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
    CLI::App* list = add_verb("list", "table of the models (default)", What::kList);
    list->add_option("--sort", request->list.sort, "column of the table of models; models without a value come last");
    list->add_flag("--desc", request->list.descending, "largest first")->needs("--sort");
    list->add_option(
        "--where", request->list.where,
        "'COLUMN OP VALUE', OP one of = != < <= > >=; may be repeated: all hold; 'COLUMN =' is what has no value, "
        "'COLUMN !=' the rest");
    CLI::Option* json = list->add_flag("--json", request->list.json, "every column, as a list of objects");
    list->add_flag("--csv", request->list.csv, "every column, as comma-separated values")->excludes(json);
    add("show", "attributes, endpoints, lines, radius along each branch, characterization and diagnostics of one model",
        What::kShow);
    add("tree", "groups and datasets of one model", What::kTree);
    CLI::App* get = add("get", "one dataset, or attribute PATH@name, as tab-separated text or for numpy", What::kGet);
    get->add_option("PATH", request->path, "dataset, as 'tree' names it")->required();
    get->add_option("-o,--output", request->output,
                    "file to write: numpy's format if its name ends in .npy, else text");

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
