#include "engine/cli/store.h"

#include <utility>

#include "engine/cli/model_io.h"
#include "io/archive/model_file.h"

namespace lumenline {

StoredModel store_model(ModelRecord record, const ModelTask& task, const ArchiveSettings& archive) {
    record.identity.inputs_sha256 = inputs_digest(task, record.identity.source_sha256, archive.options);
    StoredModel stored{summarize(record)};
    const auto fail = [&](Failure failure) {
        stored.written = false;
        stored.summary.status = ModelStatus::kFailed;
        stored.summary.failure = std::move(failure);
    };
    try {
        write_model_file(model_path(archive.directory, record.identity.id), record, archive.options);
    } catch (const StageError& error) {
        fail({error.stage(), error.code(), error.what()});
    } catch (const std::exception& error) {
        fail({Stage::kArchive, ErrorCode::kInternal,
              std::string("internal error, please report it with this model: ") + error.what()});
    }
    return stored;
}

}  // namespace lumenline
