#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace lumenline::fuzz {

/// Names of the readers: "stl", "ply", "obj", "off", "vtk_legacy", "vtk_xml", and "any", which goes by the content.
std::span<const std::string_view> readers();

/// Reads `bytes` with one reader, as if they were a file of its format.
/// @returns  empty if they were refused with a StageError of one line or gave a sound surface; else what is wrong.
///           Any other exception passes through.
std::string feed(std::string_view reader, std::string_view bytes);

}  // namespace lumenline::fuzz
