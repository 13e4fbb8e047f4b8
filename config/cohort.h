#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/archive_options.h"
#include "engine/core/branch_labels.h"
#include "engine/core/options.h"

namespace lumenline {

/// A configuration that cannot be used. `what()` is one sentence, "FILE:LINE: ..." with lines counted
/// from 1; FILE is the YAML file or the table it names. A file that cannot be read has no line: "FILE: ...".
class ConfigError : public std::runtime_error {
public:
    /// @param line  1-based; 0 = the file as a whole
    ConfigError(const std::filesystem::path& file, std::size_t line, const std::string& sentence);

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] std::size_t line() const { return line_; }  ///< 0 = the file as a whole

private:
    std::filesystem::path file_;
    std::size_t line_;
};

/// Where models are computed.
enum class Isolation {
    kNone,     ///< in the process of the run
    kProcess,  ///< in worker processes, whose crash is the failure of one model
};

std::string_view isolation_name(Isolation isolation);  ///< "none" | "process"

/// How a run uses the machine; without influence on results.
struct RunOptions {
    int threads = 0;             ///< 0 = all
    int models_in_flight = 0;    ///< models held in memory at once; 0 = automatic: 2 x threads
    double memory_percent = 70;  ///< of the memory this process may use, for the models in flight
    double memory_bytes = 0;     ///< the same in bytes, which stands instead; 0 = not stated
    double model_timeout = 0;    ///< work on one model after which it fails [s]; 0 = none
    double model_memory = 0;     ///< memory beyond which one model fails [bytes]; 0 = no limit
    Isolation isolation = Isolation::kNone;
};

/// Where results go and in which form.
struct ArchiveSettings {
    std::filesystem::path directory;  ///< absolute, or relative to the working directory
    ArchiveOptions options;
};

/// A cohort as its YAML file states it, every default filled in.
struct CohortConfig {
    std::string name;
    std::filesystem::path file;    ///< as given to load_cohort
    std::string text;              ///< of the file, byte for byte
    std::vector<ModelTask> tasks;  ///< at least one; in the order of the list or table, globs by path
    LabelOptions labels;           ///< how branches correspond across models
    RunOptions run;
    ArchiveSettings archive;
};

/// Reads a cohort's YAML file and the table or glob it names (config/SCHEMA.md).
///
/// Strict: unknown, duplicate, missing and empty keys, wrong types and values out of range are errors. Every
/// task has the same covariates in the same order, "n/a" where a model states none. Surfaces are not
/// opened: one that is missing is that model's failure, not the cohort's.
/// @param yaml      relative paths inside are relative to its folder
/// @throws ConfigError at the first error
/// @cost linear in the size of the files
CohortConfig load_cohort(const std::filesystem::path& yaml);

/// The same of a text instead of a file's: of `resolved_text`, which names no table and no glob.
/// @param yaml  the file the text stands for
CohortConfig parse_cohort(const std::string& text, const std::filesystem::path& yaml);

/// The configuration as YAML with every key explicit and the models as a list. Loaded from the same
/// folder it gives the same tasks, run and archive settings.
std::string resolved_text(const CohortConfig& config);

/// The cohort's name as a resolved text states it, which may be anybody's; "cohort" where it does not.
std::string cohort_name(const std::string& resolved);

}  // namespace lumenline
