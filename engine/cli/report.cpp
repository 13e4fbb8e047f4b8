#include "engine/cli/report.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <filesystem>
#include <memory>
#include <ostream>
#include <string>
#include <system_error>

#include "engine/cli/report_data.h"
#include "engine/cli/run.h"
#include "engine/core/text.h"
#include "io/archive/commit.h"
#include "io/archive/utf8.h"

namespace lumenline {

namespace {

struct Request {
    std::string archive, output, ratings, ratings_template;
    ReportOptions options;
};

/// Progress on standard error, where somebody looks: one line that is written over.
void say_progress(std::size_t done, std::size_t all) {
    if (all > 20 && done % 10 == 0 && ::isatty(STDERR_FILENO) == 1)
        fmt::print(stderr, "\r{} of {} models drawn", done, all);
    if (all > 20 && done + 1 == all && ::isatty(STDERR_FILENO) == 1) fmt::print(stderr, "\r\x1B[K");
}

int run(const Request& request) {
    if (!request.ratings_template.empty() && std::filesystem::exists(request.ratings_template)) {
        fmt::print(stderr, "lumenline: '{}' is there already, and ratings are not written over: name another file\n",
                   printable(request.ratings_template));
        return kUsage;
    }
    output_file(request.output);
    refuse_overwriting(request.output, request.archive);
    if (!request.options.ratings.empty()) refuse_overwriting(request.output, request.options.ratings);
    if (!request.ratings_template.empty()) {
        output_file(request.ratings_template);
        refuse_overwriting(request.ratings_template, request.archive);
        refuse_overwriting(request.output, request.ratings_template);
    }
    const Report report = gather_report(request.archive, request.options, say_progress);
    write_file(request.output, [&](std::ostream& out) { write_report(report, out); });
    if (!request.ratings_template.empty())
        write_file(request.ratings_template, [&](std::ostream& out) { out << report.ratings; });
    fmt::print("{} in {}\n", counted(report.models.size(), "model"), request.output);
    if (report.unread == 0) return kDone;
    fmt::print(stderr,
               "lumenline: the files of {} could not be read, and the page says why in the place of {}: run the cohort "
               "again\n",
               counted(report.unread, "model"), report.unread == 1 ? "its picture" : "their pictures");
    return kModelFailed;
}

}  // namespace

void add_report(CLI::App& app, std::function<int()>& action) {
    const auto request = std::make_shared<Request>();
    CLI::App* verb =
        app.add_subcommand("report", "Write one page on a cohort: methods, failures, measures, every model");
    verb->add_option("ARCHIVE", request->archive, "directory with a cohort.h5, or a packed archive")->required();
    verb->add_option("-o,--output", request->output, "HTML file to write")->required();
    verb->add_option("--by", request->options.by, "column whose groups are shown apart")->capture_default_str();
    verb->add_option("--measure", request->options.measures, "columns, with commas between; default: all measures")
        ->delimiter(',');
    verb->add_option("--ratings", request->options.ratings,
                     "TSV or CSV with the columns model, rating and note: models rated 'bad' are left out");
    verb->add_option("--template", request->ratings_template,
                     "write the table of ratings to fill in; never over a file");
    verb->add_option("--picture-size", request->options.picture_size, "of each model, in pixels")
        ->check(CLI::Range(32, 1024))
        ->capture_default_str();
    verb->footer(
        "The page needs nothing else: no scripts, nothing from outside. About 5 kB a model.\n"
        "Exit status: 0 written, 1 the archive or some models are damaged or the page cannot be written,\n"
        "2 no such archive, column or table of ratings. Of damaged models the page says what is wrong.");
    verb->callback([request, &action] { action = [request] { return run(*request); }; });
}

}  // namespace lumenline
