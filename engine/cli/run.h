#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace lumenline {

/// Exit status of the program, as documented in README and --help.
enum ExitStatus : int {
    kDone = 0,         ///< all models ok or warning
    kModelFailed = 1,  ///< at least one model failed, the rest is complete; an archive is damaged
    kUsage = 2,        ///< usage or configuration error, or no such name in an archive; nothing was computed
    kStopped = 3,      ///< interrupted
};

/// Adds the verb `run COHORT.yaml`: computes a cohort into its archive.
void add_run(CLI::App& app, std::function<int()>& action);

/// Adds the verb `validate COHORT.yaml`: checks configuration and surfaces, up to conditioning, and writes nothing.
void add_validate(CLI::App& app, std::function<int()>& action);

/// Adds the verb `model SURFACE -o OUT.hdf`: computes one surface into one model file.
void add_model(CLI::App& app, std::function<int()>& action);

}  // namespace lumenline
