#pragma once

#include <hdf5.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lumenline::damage {

/// Id of the model of `sample_cohort` that has everything, and of the one that failed.
inline constexpr const char* kWhole = "forked";
inline constexpr const char* kFailed = "broken";

/// A computed archive in a folder of this test's own: a small branching lumen in millimetres with everything a model
/// can have, and a model that failed. Computed once per process, then copied.
std::filesystem::path sample_cohort();

/// Its model file of everything.
std::filesystem::path whole_model(const std::filesystem::path& archive);

/// What is done to a dataset. Garbled: bytes of it do not fit their checksum, so that HDF5 refuses to read them.
enum class Harm { kRemoved, kShortened, kRetyped, kGarbled };
inline constexpr Harm kHarms[] = {Harm::kRemoved, Harm::kShortened, Harm::kRetyped, Harm::kGarbled};
const char* name_of(Harm harm);

/// Damages one dataset of a file; its attributes stay.
/// @returns false where that cannot be done: a scalar and what has no rows can be neither shortened nor garbled
bool harm_dataset(const std::filesystem::path& file, const std::string& path, Harm harm);

/// Changes the values of a dataset of numbers, which keeps its type.
void change_numbers(const std::filesystem::path& file, const std::string& path,
                    const std::function<void(std::vector<double>&)>& change);

/// Copies a dataset to another place of the file.
void copy_dataset(const std::filesystem::path& file, const std::string& from, const std::string& to);

/// Replaces an attribute of text or of one whole number by text.
void set_attribute(const std::filesystem::path& file, const std::string& object, const std::string& name,
                   const std::string& text);

}  // namespace lumenline::damage
