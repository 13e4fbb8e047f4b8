#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/cli/process.h"

namespace lumenline::cli_test {

/// Writes a phantom with `arguments` ("cylinder", "--b", "3") and an edge length of about 2 to `file`.
void make_phantom_file(const std::filesystem::path& file, std::vector<std::string> arguments);

/// A folder with four small phantoms (tube, bend, coil, narrow .ply) and `cohort.yaml` that lists them in
/// millimetres; the archive is `results`.
std::filesystem::path small_cohort();

/// Runs `cohort.yaml` of a folder with further arguments.
Finished run_cohort(const std::filesystem::path& folder, const std::vector<std::string>& arguments = {});

/// Values of one dataset of a model, row by row, as `browse get` prints them.
std::vector<double> get_numbers(const std::filesystem::path& folder, const std::string& archive, const std::string& id,
                                const std::string& path);

/// Text of an attribute of a model, as `browse get` prints it.
std::string get_attribute(const std::filesystem::path& folder, const std::string& archive, const std::string& id,
                          const std::string& name);

/// Files below `folder` whose name ends in `.tmp`.
std::vector<std::string> temporary_files(const std::filesystem::path& folder);

}  // namespace lumenline::cli_test
