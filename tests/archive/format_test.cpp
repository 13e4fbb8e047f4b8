// Holds written files against the tables of io/ARCHIVE.md, both ways: every dataset is documented
// with its type, rank, lengths and unit, and everything documented is there. Lengths are compared as
// the document states them, as sums like "3M+K", the letters being bound by the datasets whose length
// is a letter alone.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "io/archive/handle.h"
#include "io/archive/index.h"
#include "io/archive/model_file.h"
#include "io/archive/read.h"
#include "tests/archive/sample_record.h"

namespace lumenline {
namespace {

using Strings = std::vector<std::string>;

struct Documented {
    Strings types;
    Strings shape;  ///< empty = scalar
    std::string units;
};

struct Specification {
    std::map<std::string, Documented> datasets;
    std::map<std::string, std::string> attributes;  ///< "object@name" -> type
};

Strings split(const std::string& text, const std::string& separator) {
    Strings parts;
    std::size_t from = 0;
    for (std::size_t at = 0; (at = text.find(separator, from)) != std::string::npos; from = at + separator.size())
        parts.push_back(text.substr(from, at - from));
    parts.push_back(text.substr(from));
    return parts;
}

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" `");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" `") - first + 1);
}

/// The tables below one second-level heading of io/ARCHIVE.md.
Specification specification(const std::string& heading) {
    std::ifstream document(std::string(LUMENLINE_SOURCE_DIR) + "/io/ARCHIVE.md");
    Specification result;
    bool inside = false;
    for (std::string line; std::getline(document, line);) {
        if (line.starts_with("## ")) inside = line == "## " + heading;
        if (!inside || !line.starts_with("| `/")) continue;
        Strings cells = split(line, "|");
        std::transform(cells.begin(), cells.end(), cells.begin(), trimmed);
        if (cells.at(1).find('@') != std::string::npos) {
            result.attributes[cells[1]] = cells.at(2);
            continue;
        }
        Documented entry{split(cells.at(3), " or "), {}, cells.at(4)};
        if (cells.at(2) != "scalar") entry.shape = split(cells[2].substr(1, cells[2].size() - 2), ", ");
        EXPECT_TRUE(result.datasets.emplace(cells[1], entry).second) << cells[1] << " is documented twice";
    }
    return result;
}

/// Value of a sum of numbers, letters and multiples of letters; a letter that is not bound counts
/// nothing, since the part of the file that it measures is absent.
std::uint64_t evaluated(const std::string& sum, const std::map<char, std::uint64_t>& letters) {
    std::uint64_t value = 0;
    for (const std::string& term : split(sum, "+")) {
        std::size_t digits = 0;
        const std::uint64_t factor = std::isdigit(static_cast<unsigned char>(term[0])) ? std::stoull(term, &digits) : 1;
        if (digits == term.size()) {
            value += factor;
        } else if (const auto bound = letters.find(term[digits]); bound != letters.end()) {
            value += factor * bound->second;
        }
    }
    return value;
}

/// Name under which a dataset is documented: covariates share one entry.
std::string documented_name(const ArchiveFile& file, const ArchiveNode& node) {
    return file.attribute(node.path, "column") ? "/tables/models/<covariate>" : node.path;
}

std::map<char, std::uint64_t> bound_letters(const ArchiveFile& file, const Specification& spec) {
    std::map<char, std::uint64_t> letters;
    for (const ArchiveNode& node : file.nodes())
        if (const auto entry = spec.datasets.find(documented_name(file, node)); entry != spec.datasets.end())
            for (std::size_t d = 0; d < std::min(node.shape.size(), entry->second.shape.size()); ++d)
                if (const std::string& length = entry->second.shape[d]; length.size() == 1 && std::isalpha(length[0]))
                    letters.emplace(length[0], node.shape[d]);
    return letters;
}

/// All that is wrong with a dataset.
Strings complaints_about(const ArchiveNode& node, const Documented& entry, const std::map<char, std::uint64_t>& letters,
                         const std::string& length_unit) {
    Strings found;
    if (std::find(entry.types.begin(), entry.types.end(), node.type) == entry.types.end())
        found.push_back(node.path + " has type " + node.type);
    if (node.shape.size() != entry.shape.size())
        found.push_back(node.path + " has shape " + shape_text(node.shape));
    else
        for (std::size_t d = 0; d < node.shape.size(); ++d)
            if (evaluated(entry.shape[d], letters) != node.shape[d])
                found.push_back(node.path + " has " + std::to_string(node.shape[d]) + " where " + entry.shape[d] +
                                " is documented");
    std::string units = entry.units;
    if (const std::size_t at = units.find("length"); at != std::string::npos) units.replace(at, 6, length_unit);
    if (node.units != units) found.push_back(node.path + " has unit " + node.units);
    if (node.description.empty()) found.push_back(node.path + " has no description");
    return found;
}

/// All that is wrong with a file. `seen` collects the documented names that were met.
Strings complaints(const ArchiveFile& file, const Specification& spec, std::set<std::string>& seen) {
    Strings found;
    const std::map<char, std::uint64_t> letters = bound_letters(file, spec);
    for (const ArchiveNode& node : file.nodes()) {
        const std::string prefix = node.path;
        if (node.is_group) {
            for (const auto& [name, value] : file.attributes(node.path)) {
                seen.insert(prefix + "@" + name);
                if (!spec.attributes.contains(prefix + "@" + name))
                    found.push_back(prefix + "@" + name + " is not documented");
            }
            continue;
        }
        const std::string name = documented_name(file, node);
        seen.insert(name);
        if (const auto entry = spec.datasets.find(name); entry == spec.datasets.end()) {
            found.push_back(node.path + " is not documented");
        } else {
            const Strings more = complaints_about(node, entry->second, letters, "mm");
            found.insert(found.end(), more.begin(), more.end());
        }
    }
    return found;
}

Strings missing(const Specification& spec, const std::set<std::string>& seen) {
    Strings found;
    for (const auto& [name, entry] : spec.datasets)
        if (!seen.contains(name)) found.push_back(name);
    for (const auto& [name, type] : spec.attributes)
        if (!seen.contains(name)) found.push_back(name);
    return found;
}

std::filesystem::path sample_file(const std::string& name, const ModelRecord& record = sample_record()) {
    std::filesystem::path file = fresh_directory(name) / "m.hdf";
    write_model_file(file, record);
    return file;
}

TEST(Format, ModelFileIsAsDocumented) {
    const Specification spec = specification("Model file");
    ASSERT_GT(spec.datasets.size(), 50U);
    std::set<std::string> seen;
    EXPECT_EQ(complaints(ArchiveFile(sample_file("format")), spec, seen), Strings{});
    EXPECT_EQ(complaints(ArchiveFile(sample_file("format_failed", failed_record())), spec, seen), Strings{});
    ModelRecord crashed = failed_record();
    crashed.failure->code = ErrorCode::kCrashed;
    crashed.failure->signal = 11;
    EXPECT_EQ(complaints(ArchiveFile(sample_file("format_crashed", crashed)), spec, seen), Strings{});
    EXPECT_EQ(missing(spec, seen), Strings{});
}

TEST(Format, IndexIsAsDocumented) {
    const Specification spec = specification("Index");
    ASSERT_GT(spec.datasets.size(), 30U);
    const auto directory = sample_archive({sample_record("a"), sample_record("b"), failed_record("c")}, "format_index");
    std::set<std::string> seen;
    EXPECT_EQ(complaints(ArchiveFile(directory / "cohort.h5"), spec, seen), Strings{});
    EXPECT_EQ(missing(spec, seen), Strings{});
}

/// Adds or replaces a dataset of doubles without attributes.
void put(const std::filesystem::path& path, const char* name, hid_t type, std::vector<hsize_t> shape) {
    const hdf::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, hdf::file_access().get()), H5Fclose, "open");
    if (H5Lexists(file.get(), name, H5P_DEFAULT) > 0) hdf::checked(H5Ldelete(file.get(), name, H5P_DEFAULT), name);
    const hdf::Handle made(
        H5Dcreate2(file.get(), name, type, hdf::extent(static_cast<int>(shape.size()), shape.data()).get(), H5P_DEFAULT,
                   H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose, name);
}

TEST(Format, CheckerSeesWhatIsNotDocumented) {
    const Specification spec = specification("Model file");
    const auto found = [&](const char* name, hid_t type, const std::vector<hsize_t>& shape) {
        const auto file = sample_file("format_checker");
        put(file, name, type, shape);
        std::set<std::string> seen;
        std::string text;
        for (const std::string& complaint : complaints(ArchiveFile(file), spec, seen)) text += complaint + "; ";
        return text;
    };
    const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
    EXPECT_TRUE(has(found("/surface/extra", H5T_IEEE_F64LE, {5}), "/surface/extra is not documented"));
    EXPECT_TRUE(has(found("/surface/pole", H5T_IEEE_F64LE, {5}), "/surface/pole has type float64"));
    EXPECT_TRUE(has(found("/surface/pole", H5T_STD_I32LE, {5, 1}), "/surface/pole has shape (5, 1)"));
    EXPECT_TRUE(has(found("/surface/pole", H5T_STD_I32LE, {6}), "has 6 where N is documented"));
    EXPECT_TRUE(has(found("/voronoi/polygon_offsets", H5T_STD_I32LE, {3}), "has 3 where P+1 is documented"));
    EXPECT_TRUE(has(found("/centerlines/radius", H5T_IEEE_F64LE, {9}), "/centerlines/radius has unit"));
    EXPECT_TRUE(has(found("/centerlines/radius", H5T_IEEE_F64LE, {9}), "/centerlines/radius has no description"));
}

TEST(Format, CheckerSeesWhatIsMissing) {
    const Specification spec = specification("Model file");
    std::set<std::string> seen;
    complaints(ArchiveFile(sample_file("format_missing", failed_record())), spec, seen);
    const Strings absent = missing(spec, seen);
    EXPECT_NE(std::find(absent.begin(), absent.end(), "/centerlines/radius"), absent.end());
}

}  // namespace
}  // namespace lumenline
