// io/ARCHIVE.md and the specification in code name the same datasets and attributes, with the same types, shapes and
// units: neither can change without the other.
#include "io/archive/specification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

namespace lumenline {
namespace {

struct Lines {
    std::vector<std::string> datasets, attributes;  ///< "path | shape | type | units", "object@name | type"
};

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" `()");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" `()") - first + 1);
}

/// The tables below one second-level heading of a document.
Lines documented(const std::filesystem::path& file, const std::string& heading) {
    std::ifstream document(file);
    Lines result;
    bool inside = false;
    for (std::string line; std::getline(document, line);) {
        if (line.starts_with("## ")) inside = line == "## " + heading;
        if (!inside || !line.starts_with("| `/")) continue;
        std::vector<std::string> cells;
        std::size_t from = 1;
        for (std::size_t at = 0; (at = line.find('|', from)) != line.npos && cells.size() < 4; from = at + 1)
            cells.push_back(trimmed(line.substr(from, at - from)));
        if (cells.at(0).find('@') != std::string::npos)
            result.attributes.push_back(cells[0] + " | " + cells.at(1));
        else
            result.datasets.push_back(cells[0] + " | " + cells.at(1) + " | " + cells.at(2) + " | " + cells.at(3));
    }
    std::sort(result.datasets.begin(), result.datasets.end());
    std::sort(result.attributes.begin(), result.attributes.end());
    return result;
}

Lines specified(const std::vector<Specified>& datasets, const std::vector<SpecifiedAttribute>& attributes) {
    Lines result;
    for (const Specified& entry : datasets)
        result.datasets.push_back(entry.path + " | " + (entry.shape.empty() ? "scalar" : entry.shape) + " | " +
                                  entry.types + " | " + entry.units);
    for (const SpecifiedAttribute& entry : attributes)
        result.attributes.push_back(std::string(entry.object) + "@" + entry.name + " | " + entry.type);
    std::sort(result.datasets.begin(), result.datasets.end());
    std::sort(result.attributes.begin(), result.attributes.end());
    return result;
}

const std::filesystem::path kDocument = std::filesystem::path(LUMENLINE_SOURCE_DIR) / "io" / "ARCHIVE.md";

TEST(Specification, ModelIsTheDocuments) {
    const Lines in_document = documented(kDocument, "Model file");
    const Lines in_code = specified(model_specification(), model_attributes());
    EXPECT_GT(in_code.datasets.size(), 200U);
    EXPECT_EQ(in_code.datasets, in_document.datasets);
    EXPECT_EQ(in_code.attributes, in_document.attributes);
}

TEST(Specification, IndexIsTheDocuments) {
    const Lines in_document = documented(kDocument, "Index");
    const Lines in_code = specified(index_specification(), index_attributes());
    EXPECT_EQ(in_code.datasets, in_document.datasets);
    EXPECT_EQ(in_code.attributes, in_document.attributes);
}

TEST(Specification, NamesEachDatasetOnce) {
    for (const auto* specification : {&model_specification(), &index_specification()}) {
        std::map<std::string, int> seen;
        for (const Specified& entry : *specification) EXPECT_EQ(++seen[entry.path], 1) << entry.path;
    }
}

}  // namespace
}  // namespace lumenline
