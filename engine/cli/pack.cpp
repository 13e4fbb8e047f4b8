#include "engine/cli/pack.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "engine/cli/run.h"
#include "engine/core/text.h"
#include "io/archive/pack.h"

namespace lumenline {

namespace {

int run(const std::string& archive, const std::string& file) {
    const Packed packed = pack_archive(archive, file, nullptr);
    fmt::print("{} packed into {}\n", counted(packed.models, "model"), file);
    if (packed.missing == 0) return kDone;
    fmt::print(stderr, "lumenline: {} of the index had no file and {} left out: run the cohort again\n",
               counted(packed.missing, "model"), packed.missing == 1 ? "is" : "are");
    return kModelFailed;
}

}  // namespace

void add_pack(CLI::App& app, std::function<int()>& action) {
    struct Request {
        std::string archive, file;
    };
    const auto request = std::make_shared<Request>();
    CLI::App* verb = app.add_subcommand("pack", "Copy an archive into one file, for viewers that follow no links");
    verb->add_option("ARCHIVE", request->archive, "directory with a cohort.h5")->required();
    verb->add_option("-o,--output", request->file, "file to write, as one.h5")->required();
    verb->footer(
        "Exit status: 0 all models are packed, 1 some had no file, the archive is damaged or cannot be packed,\n"
        "2 no such archive.");
    verb->callback([request, &action] { action = [request] { return run(request->archive, request->file); }; });
}

}  // namespace lumenline
