// A run opens each model's file before it takes it for done; people who ask how far a cohort has come want to know at
// once. Ten thousand files are looked at in a tenth of a second, but opened by HDF5 in several.

#include <sys/stat.h>

#include <cmath>
#include <limits>
#include <utility>

#include "engine/core/version.h"
#include "io/archive/file_stamp.h"
#include "io/archive/index.h"
#include "io/archive/index_names.h"
#include "io/archive/model_file.h"
#include "io/archive/read.h"
#include "io/archive/utf8.h"

namespace lumenline {

FileStamp stamp_of(const std::filesystem::path& file) {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return {kNaN, kNaN};
    return {static_cast<double>(status.st_size),
            static_cast<double>(status.st_mtim.tv_sec) + 1e-9 * static_cast<double>(status.st_mtim.tv_nsec)};
}

std::map<std::string, ModelSummary> read_unchanged_rows(const std::filesystem::path& archive_dir) {
    std::map<std::string, ModelSummary> rows;
    const std::filesystem::path file = archive_dir / names::kIndexFile;
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return rows;
    try {
        const ArchiveFile index(file);
        if (!index.has(names::kFileTime.path)) return rows;  // an index of an earlier version
        const std::vector<double> bytes = index.numbers(names::kFileBytes.path),
                                  times = index.numbers(names::kFileTime.path);
        std::vector<ModelSummary> models = read_index(file);
        if (bytes.size() != models.size() || times.size() != models.size()) return rows;
        for (std::size_t row = 0; row < models.size(); ++row) {
            const std::string id = models[row].identity.id;
            if (id.find('/') == std::string::npos &&
                stamp_of(model_path(archive_dir, id)) == FileStamp{bytes[row], times[row]})
                rows.emplace(id, std::move(models[row]));
        }
    } catch (const ArchiveError&) {
        rows.clear();
    }
    return rows;
}

bool index_is_of(const std::filesystem::path& archive_dir, std::string_view config_text,
                 std::string_view resolved_config) {
    try {
        const ArchiveFile index(archive_dir / names::kIndexFile);
        const auto holds = [&](const names::Field& field, std::string_view text) {
            return index.strings(field.path) == std::vector<std::string>{valid_text(text)};
        };
        return index.attribute("/", "lumenline_version") == version() && index.has(names::kDictionaryTable.path) &&
               holds(names::kConfigGiven, config_text) && holds(names::kConfigResolved, resolved_config);
    } catch (const ArchiveError&) {
        return false;
    }
}

}  // namespace lumenline
