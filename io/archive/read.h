#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/data_table.h"
#include "engine/core/model_record.h"
#include "io/archive/errors.h"

namespace lumenline {

/// A group or dataset of an HDF5 file.
struct ArchiveNode {
    std::string path;  ///< from the root, "/surface/points"
    bool is_group = false;
    std::string type;                  ///< "float64", "int32", "string", ...; empty for a group
    std::vector<std::uint64_t> shape;  ///< empty for a scalar
    std::string units, description;    ///< empty where the file has none
};

/// "(12, 3)", "(12)", "scalar".
std::string shape_text(const std::vector<std::uint64_t>& shape);

/// One HDF5 file of an archive, opened for reading.
///
/// Nothing in it is trusted: a wrong type or rank, a dataset larger than the file or a missing
/// name throws ArchiveError or UnknownName, with the file and the path in the sentence.
class ArchiveFile {
public:
    /// @throws UnknownName if there is no such file; ArchiveError if it is no HDF5 file, is
    ///         truncated, is not of ours, or is of a newer format
    /// @param root  the group that stands for the root: "/models/<id>" of a packed archive is a model's file
    explicit ArchiveFile(const std::filesystem::path& file, const std::string& root = "/");
    ~ArchiveFile();
    ArchiveFile(ArchiveFile&&) noexcept;
    ArchiveFile& operator=(ArchiveFile&&) = delete;

    [[nodiscard]] const std::filesystem::path& file() const;
    /// `format` attribute: "lumenline-model" or "lumenline-cohort".
    [[nodiscard]] const std::string& format() const;

    [[nodiscard]] bool has(const std::string& path) const;
    [[nodiscard]] std::vector<std::uint64_t> shape(const std::string& path) const;
    /// Values of a dataset of numbers, row by row.
    [[nodiscard]] std::vector<double> numbers(const std::string& path) const;
    /// Values of a dataset of numbers in the bytes of the file's type, little-endian.
    [[nodiscard]] std::string bytes(const std::string& path) const;
    /// Values of a dataset of text.
    [[nodiscard]] std::vector<std::string> strings(const std::string& path) const;
    /// Text of an attribute; empty optional if the object has no such attribute.
    [[nodiscard]] std::optional<std::string> attribute(const std::string& object, const std::string& name) const;
    /// Names and values (as text) of all attributes of an object, by name.
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> attributes(const std::string& object) const;

    /// All groups and datasets, parents before children, by name. Links to other files are left out.
    [[nodiscard]] std::vector<ArchiveNode> nodes() const;

    /// Looks whether every object and attribute can be read, and whether values lie within the file: HDF5 copies
    /// without looking, and crashes where they do not.
    /// @cost O(objects)
    void require_copyable() const;

    /// Writes a dataset, or an attribute "PATH@name", as tab-separated text: one line per index of
    /// the first dimension, numbers as the shortest text that reads back as the same number,
    /// control characters in text as '?'. Large datasets are read in blocks.
    /// @throws UnknownName with the nearest names if there is no such thing
    void print(const std::string& path_or_attribute, std::ostream& out) const;
    /// Writes the same in numpy's .npy format, version 1.0: numbers in their own type, text as `<U`.
    void save_npy(const std::string& path_or_attribute, std::ostream& out) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The index of an archive that is a directory; the archive itself if it is a file.
/// @throws UnknownName if there is neither
std::filesystem::path index_or_file(const std::filesystem::path& archive);

/// The models of an archive: rows of the index of a directory (or of its cohort.h5), or the one
/// model of a model file.
/// @throws ArchiveError, UnknownName if the archive does not exist or a directory has no index
std::vector<ModelSummary> list_models(const std::filesystem::path& archive);

/// A table of an archive's index. Columns of the table of models that another table lacks are joined by the models'
/// ids. Measures are the columns of floating point numbers that are no covariates.
/// @throws ArchiveError; UnknownName with the nearest names if there is no such table
DataTable read_data_table(const std::filesystem::path& archive, const std::string& table);

/// The record of the model `id` of an archive: its file, or its group of a packed one.
/// @throws ArchiveError; UnknownName with the nearest ids if the archive has no such model
ArchiveFile open_model(const std::filesystem::path& archive, const std::string& id);

/// "; the nearest names are 'a', 'b'": the up to three of `names` with the least edit distance to
/// `wanted`, control characters as '?'. Empty if there are no names.
std::string nearest_names(std::string_view wanted, std::span<const std::string> names);

}  // namespace lumenline
