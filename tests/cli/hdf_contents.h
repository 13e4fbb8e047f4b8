#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lumenline::cli_test {

/// Everything in an HDF5 file by name, "/surface/points" or "/surface@genus": type, shape and bytes of datasets
/// and attributes, the word "group", the target of a link. Names below those in `without` are left out.
/// @throws std::runtime_error if the file is no complete HDF5 file
std::map<std::string, std::string> hdf_contents(const std::filesystem::path& file,
                                                const std::vector<std::string>& without = {"/provenance", "/timing"});

/// Files below a folder that a reader takes for complete HDF5 files, in order.
std::vector<std::filesystem::path> hdf_files(const std::filesystem::path& folder);

/// Everything in them, but for times and hosts, by file and name: "models/tube.hdf/surface/points".
/// @throws std::runtime_error if one is no complete HDF5 file
std::map<std::string, std::string> archive_contents(const std::filesystem::path& folder);

/// Names whose contents differ, or that only one of the two has.
std::vector<std::string> differences(const std::map<std::string, std::string>& a,
                                     const std::map<std::string, std::string>& b);

}  // namespace lumenline::cli_test
