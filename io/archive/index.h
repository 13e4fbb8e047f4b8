#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/branch_labels.h"
#include "engine/core/model_record.h"
#include "io/archive/errors.h"

namespace lumenline {

/// Labels of the branches of all models from their trees, both in the order of the rows.
using BranchLabeller = std::function<std::vector<BranchLabels>(std::span<const BranchTree>)>;

/// Writes `cohort.h5` of an archive: an external link to each model's file, the tables, and the
/// configuration, in the format of io/ARCHIVE.md.
///
/// One row per model, in the order given. Lengths and radii of a model without lines are NaN. A
/// covariate that any model has becomes a column of all: of numbers (NaN where a model has none)
/// if all its values that are neither empty nor "n/a" are numbers, else of text. Seconds go to
/// /timing, so that the bytes outside of it depend on the models and the configuration alone.
/// The rows of the branches' tables come from the model files, one model after the other, so that memory does not grow
/// with them; a model without a file, or with one that cannot be read, has none. Written and renamed like a model file.
///
/// @param archive_dir  must exist
/// @param label        labels the branches; without it they have none
/// @returns            a sentence for each file that cannot be read
/// @throws StageError kArchiveWrite; kInternal if an id is no file name or appears twice
/// @cost two looks at each model file: some milliseconds a model
std::vector<std::string> write_index(const std::filesystem::path& archive_dir, std::span<const ModelSummary> models,
                                     std::string_view config_text, std::string_view resolved_config,
                                     const BranchLabeller& label = {});

/// Models of `cohort.h5` as their table states them, without covariates and with the length 0
/// (as `summarize` gives it) where the table has NaN.
/// @throws ArchiveError, UnknownName if the file does not exist
std::vector<ModelSummary> read_index(const std::filesystem::path& index_file);

/// What `summarize` made of the record that was written to `model_file`, from the file alone.
/// @throws ArchiveError, UnknownName if the file does not exist
/// @cost   reads the arrays of the centerlines, not those of the surface or the complex
ModelSummary read_summary(const std::filesystem::path& model_file);

/// What a model's file says of the run that made it.
struct ModelState {
    std::string id;
    ModelStatus status = ModelStatus::kFailed;
    std::string source_sha256, inputs_sha256;
    std::optional<Failure> failure;
    double seconds = 0;  ///< of work
};

/// Rows of the index by id, as read_index gives them, of the models whose files have the size and the time stamp that
/// they had when it was made. What is missing here is for read_summary. Empty if there is no index, or it is of no use.
/// @cost   one look at each file's entry in its folder; no model file is opened
std::map<std::string, ModelSummary> read_unchanged_rows(const std::filesystem::path& archive_dir);

/// Was the index that stands made by this program from this configuration? If also all of its models are unchanged, one
/// made anew would be the same.
bool index_is_of(const std::filesystem::path& archive_dir, std::string_view config_text,
                 std::string_view resolved_config);

/// The state of a model from the attributes of its file alone; empty if there is no file.
/// @throws ArchiveError if it is no model file, or damaged
std::optional<ModelState> read_state(const std::filesystem::path& model_file);

}  // namespace lumenline
