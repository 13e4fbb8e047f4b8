#include "engine/cli/validate_archive.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <ostream>
#include <string>

#include "engine/cli/run.h"
#include "engine/cli/standard_output.h"
#include "engine/core/text.h"
#include "io/archive/validate.h"

namespace lumenline {

namespace {

int run(const std::string& archive) {
    const Validation result = validate_archive(archive);
    to_standard_output([&](std::ostream& out) {
        for (const Finding& finding : result.findings) out << finding.sentence() << '\n';
        out << counted(result.files, "file") << ", " << counted(result.datasets, "dataset") << ": "
            << (result.findings.empty() ? "all as specified" : counted(result.findings.size(), "finding"));
        if (result.others > 0)
            out << "; " << counted(result.others, "dataset") << " of others that the format does not name";
        out << '\n';
    });
    return result.findings.empty() ? kDone : kModelFailed;
}

}  // namespace

void add_validate_archive(CLI::App& app, std::function<int()>& action) {
    const auto archive = std::make_shared<std::string>();
    CLI::App* verb = app.add_subcommand("validate-archive", "Hold an archive against its specification, io/ARCHIVE.md");
    verb->add_option("ARCHIVE", *archive, "directory with a cohort.h5, a packed archive, or one model file")
        ->required();
    verb->footer(
        "One sentence a finding: file, dataset, what is wrong and where.\n"
        "Exit status: 0 all is as specified, 1 something is not, 2 there is no such archive.");
    verb->callback([archive, &action] { action = [archive] { return run(*archive); }; });
}

}  // namespace lumenline
