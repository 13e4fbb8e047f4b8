// The command line: every verb sets the action to run.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "engine/cli/browse.h"
#include "engine/cli/export.h"
#include "engine/cli/isolated.h"
#include "engine/cli/pack.h"
#include "engine/cli/phantom.h"
#include "engine/cli/report.h"
#include "engine/cli/run.h"
#include "engine/cli/stats.h"
#include "engine/cli/status.h"
#include "engine/cli/status_of.h"
#include "engine/cli/submit.h"
#include "engine/cli/validate_archive.h"
#include "engine/core/version.h"

namespace {

/// One line, with the verb whose help says more.
std::string usage_sentence(const CLI::App* app, const CLI::Error& error) {
    std::string verb = app->get_name();
    for (auto chosen = app->get_subcommands(); !chosen.empty(); chosen = chosen.front()->get_subcommands())
        verb += " " + chosen.front()->get_name();
    return fmt::format("lumenline: {}; {} --help lists what there is\n", error.what(), verb);
}

}  // namespace

int main(int argc, char** argv) {
    using namespace lumenline;
    CLI::App app("Lumenline: centerlines and surface geometry of vascular cohorts", "lumenline");
    app.set_version_flag("--version",
                         fmt::format("lumenline {} ({}, {})", version(), build_commit(), build_compiler()));
    app.require_subcommand(1);
    app.failure_message(usage_sentence);
    app.footer(
        "Results go to standard output, progress and diagnostics to standard error.\n"
        "Exit status: 0 all models ok or warning, 1 at least one failed, 2 usage or configuration error, 3 stopped.");
    std::function<int()> action;
    add_run(app, action);
    add_status(app, action);
    add_merge(app, action);
    add_submit(app, action);
    add_validate(app, action);
    add_model(app, action);
    add_browse(app, action);
    add_stats(app, action);
    add_pack(app, action);
    add_export(app, action);
    add_report(app, action);
    add_validate_archive(app, action);
    add_phantom(app, action);
    add_worker(app, action);
    try {
        app.parse(argc, argv);
        return status_of(action);
    } catch (const CLI::RequiredError& error) {
        if (argc > 1 && app.get_subcommands().empty())
            fmt::print(stderr, "lumenline: unknown verb or option '{}'; lumenline --help lists them\n", argv[1]);
        else
            app.exit(error);
        return kUsage;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? kDone : kUsage;
    }
}
