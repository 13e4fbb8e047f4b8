// An archive is a directory with an index, that index, or one model file. Ids and paths inside the
// files are not trusted: an id that is no plain file name is refused before it becomes a path.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "io/archive/index.h"
#include "io/archive/index_names.h"
#include "io/archive/model_file.h"
#include "io/archive/read.h"
#include "io/archive/utf8.h"

namespace lumenline {

namespace {

constexpr std::size_t kMostNames = 3;

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

std::vector<std::string> ids_of(const ArchiveFile& file) {
    if (file.format() == names::kCohortFormat) return file.strings(names::kId.path);
    return {file.attribute("/", "id").value_or("")};
}

}  // namespace

std::filesystem::path index_or_file(const std::filesystem::path& archive) {
    std::error_code error;
    if (!std::filesystem::exists(archive, error)) throw UnknownName("there is no archive '" + archive.string() + "'");
    if (!std::filesystem::is_directory(archive, error)) return archive;
    const std::filesystem::path index = archive / names::kIndexFile;
    if (!std::filesystem::exists(index, error))
        throw UnknownName("the directory '" + archive.string() + "' has no index " + names::kIndexFile +
                          ": it is no archive, or its run has not ended: run it again to make the index");
    return index;
}

std::string nearest_names(std::string_view wanted, std::span<const std::string> names) {
    std::vector<std::pair<std::size_t, std::string_view>> ranked;
    for (const std::string& name : names) ranked.emplace_back(edit_distance(wanted, name), name);
    const auto end = ranked.begin() + static_cast<std::ptrdiff_t>(std::min(ranked.size(), kMostNames));
    std::partial_sort(ranked.begin(), end, ranked.end());
    std::string text;
    for (auto it = ranked.begin(); it != end; ++it)
        text += std::string(it == ranked.begin() ? "" : ", ") + "'" + printable(it->second) + "'";
    if (text.empty()) return "";
    return (ranked.size() == 1 ? "; the only one is " : "; the nearest are ") + text;
}

std::vector<ModelSummary> list_models(const std::filesystem::path& archive) {
    const std::filesystem::path path = index_or_file(archive);
    if (ArchiveFile(path).format() == names::kCohortFormat) return read_index(path);
    return {read_summary(path)};
}

ArchiveFile open_model(const std::filesystem::path& archive, const std::string& id) {
    ArchiveFile file(index_or_file(archive));
    const std::vector<std::string> ids = ids_of(file);
    if (std::find(ids.begin(), ids.end(), id) == ids.end())
        throw UnknownName("the archive '" + archive.string() + "' has no model '" + printable(id) + "'" +
                          nearest_names(id, ids));
    if (file.format() == names::kModelFormat) return file;
    if (id.empty() || id.find('/') != std::string::npos)
        throw ArchiveError("the index '" + file.file().string() + "' names a model '" + printable(id) +
                           "', which is no file name");
    if (file.attribute("/", names::kPackedAttribute))
        return ArchiveFile(file.file(), std::string(names::kModelLinks) + "/" + id);
    const std::filesystem::path model = model_path(file.file().parent_path(), id);
    std::error_code error;
    if (!std::filesystem::exists(model, error))
        throw ArchiveError("the index names the model '" + printable(id) + "' but its file '" + model.string() +
                           "' does not exist: run the cohort again");
    return ArchiveFile(model);
}

}  // namespace lumenline
