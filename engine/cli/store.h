#pragma once

#include "config/cohort.h"
#include "engine/core/model_record.h"
#include "engine/core/options.h"

namespace lumenline {

/// What became of a record.
struct StoredModel {
    ModelSummary summary;
    bool written = true;  ///< its file stands; else `summary` has the failure of kArchive
};

/// Writes the record of `task` into the archive; a file that cannot be written is the model's failure.
StoredModel store_model(ModelRecord record, const ModelTask& task, const ArchiveSettings& archive);

}  // namespace lumenline
