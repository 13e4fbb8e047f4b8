#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace lumenline {

/// Adds the verb `browse ARCHIVE [list | show ID | get ID PATH | tree ID | serve | page]`, which
/// prints what an archive holds to standard output, or shows it in a browser.
///
/// When the verb was parsed, `action` is set to the function that does it. The function returns
/// the exit status (engine/cli/run.h) and throws nothing: kDone, also when the reader of the output has
/// gone; kModelFailed where the archive is damaged or the output cannot be written; kUsage where there is
/// no such archive, model, dataset, attribute or column. Its one sentence goes to standard error.
///
/// Ids and paths may be spelled like a verb as long as `app.require_subcommand(1)` is set.
/// `action` must live as long as `app`.
void add_browse(CLI::App& app, std::function<int()>& action);

}  // namespace lumenline
