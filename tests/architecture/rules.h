#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lumenline::architecture {

/// Text of each file by its path from the repository's root, "engine/core/vec3.h".
using Tree = std::map<std::string, std::string>;

/// One sentence each, "FILE:LINE: what is wrong"; empty = all is well.
using Violations = std::vector<std::string>;

/// All .h, .cpp and CMakeLists.txt below the given folders of `root`.
Tree read_tree(const std::filesystem::path& root, const std::vector<std::string>& folders);

/// Who includes whom: rooms that may not see each other, heavy libraries outside of their rooms, or in a header
/// that another room reaches, own headers not named from the root, and rooms for which there is no rule.
Violations include_violations(const Tree& tree);

/// Headers of more than 150 lines, sources of more than 400.
Violations size_violations(const Tree& tree);

/// Marks of unfinished work.
Violations wording_violations(const Tree& tree);

/// Sources that no CMakeLists.txt of their folder, or of one above it, lists by name.
Violations listing_violations(const Tree& tree);

}  // namespace lumenline::architecture
