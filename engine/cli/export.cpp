#include "engine/cli/export.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/cli/run.h"
#include "engine/core/text.h"
#include "io/archive/commit.h"
#include "io/archive/read.h"
#include "io/archive/utf8.h"
#include "io/export/tables.h"
#include "io/export/vtp.h"

namespace lumenline {

namespace {

struct Request {
    std::string archive, format, directory;
    std::vector<std::string> models;
};

std::size_t export_models(const Request& request) {
    std::vector<std::string> ids = request.models;
    if (ids.empty())
        for (const ModelSummary& model : list_models(request.archive)) ids.push_back(model.identity.id);
    std::size_t files = 0;
    for (const std::string& id : ids) {
        const std::size_t written = export_vtp(open_model(request.archive, id), request.directory).size();
        if (written == 0) fmt::print(stderr, "lumenline: model '{}' has nothing to export: it failed\n", printable(id));
        files += written;
    }
    return files;
}

int run(const Request& request) {
    if (request.format != "vtp" && !request.models.empty()) {
        fmt::print(stderr, "lumenline: --model goes with --to vtp only: tables are of all models\n");
        return kUsage;
    }
    make_directories(request.directory);
    const std::size_t files = request.format == "vtp"
                                  ? export_models(request)
                                  : export_tables(request.archive, request.directory,
                                                  request.format == "csv" ? TableFormat::kCsv : TableFormat::kTsv)
                                        .size();
    fmt::print("{} written to {}\n", counted(files, "file"), request.directory);
    return files > 0 ? kDone : kModelFailed;
}

}  // namespace

void add_export(CLI::App& app, std::function<int()>& action) {
    const auto request = std::make_shared<Request>();
    CLI::App* verb = app.add_subcommand("export", "Write models or tables for other programs");
    verb->add_option("ARCHIVE", request->archive, "directory with a cohort.h5, a packed archive, or one model file")
        ->required();
    verb->add_option("--to", request->format,
                     "vtp: surface, lines and Voronoi diagram of each model, for VMTK, Slicer, SimVascular, ParaView; "
                     "csv, tsv: the tables of the cohort, and dictionary.json, which says what their columns are")
        ->required()
        ->check(CLI::IsMember({"vtp", "csv", "tsv"}));
    verb->add_option("-o,--output", request->directory, "directory, made where it is missing")->required();
    verb->add_option("--model", request->models, "of these models only; may be repeated (vtp)");
    verb->footer(
        "Exit status: 0 written, 1 the archive is damaged, a file cannot be written or there was nothing to write,\n"
        "2 usage error, no such archive or model.");
    verb->callback([request, &action] { action = [request] { return run(*request); }; });
}

}  // namespace lumenline
