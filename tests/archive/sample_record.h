#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/model_record.h"

namespace lumenline {

/// A complete record, small enough to be written by hand: a double pyramid of 5 sites and 6
/// triangles with three openings, 7 Voronoi vertices in 3 polygons (one of them a bare edge), two
/// sources, two lines of 5 and 4 points. No two lengths that the format tells apart are equal.
ModelRecord sample_record(const std::string& id = "sample");

/// A model that failed while its front was marched: surface and complex, but no lines.
ModelRecord failed_record(const std::string& id = "failed");

/// An archive of the given records, with its index and a configuration of two lines, in a directory of its own.
std::filesystem::path sample_archive(const std::vector<ModelRecord>& records, const std::string& name);

/// An empty directory of its own below the tests' temporary directory.
std::filesystem::path fresh_directory(const std::string& name);

/// All bytes of a file.
std::string bytes_of(const std::filesystem::path& file);
void write_bytes(const std::filesystem::path& file, const std::string& bytes);

/// Expects numbers to be equal, one by one, or both NaN.
void expect_same(const std::vector<double>& a, const std::vector<double>& b, const std::string& what);

/// Empty if the summaries are equal in every field, else the first field that differs.
std::string difference(const ModelSummary& a, const ModelSummary& b);

}  // namespace lumenline
