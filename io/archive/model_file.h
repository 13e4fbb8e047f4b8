#pragma once

#include <filesystem>
#include <string_view>

#include "engine/core/archive_options.h"
#include "engine/core/model_record.h"

namespace lumenline {

/// Writes what `options` ask for of all that `record` knows to `file`, in the format of io/ARCHIVE.md.
///
/// The file is gathered as "<file>.tmp", synced and renamed, so that `file` is never seen
/// incomplete; an older `file` is replaced. Parts of the record that are null are left out. A
/// failed model is written like any other, with the attributes failure_stage, failure_code and
/// failure_sentence. Bytes outside of /provenance and /timing depend on the record alone.
/// The directory must exist. HDF5 admits one thread at a time: call it from one thread.
///
/// @throws StageError kArchiveWrite if the file cannot be written; kInternal if an array of the record
///         has another length than the record asks for, or an index does not fit into 31 bits
/// @cost   one pass over the data; memory beside the record: about 50 bytes per triangle
void write_model_file(const std::filesystem::path& file, const ModelRecord& record, const ArchiveOptions& options = {});

/// "<archive_dir>/models/<id>.hdf", the place of a model's file in an archive.
std::filesystem::path model_path(const std::filesystem::path& archive_dir, std::string_view id);

}  // namespace lumenline
