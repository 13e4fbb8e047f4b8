#pragma once

#include <string>

#include "engine/core/vec3.h"

namespace lumenline {

/// Shortest decimal text that reads back as the same double; "nan", "inf" where not finite.
std::string exact_text(double value);

/// Number for people: `digits` significant digits.
std::string short_text(double value, int digits = 4);

/// "(x, y, z)" with `digits` significant digits each.
std::string short_text(Vec3 point, int digits = 5);

/// "1 opening", "3 openings": the noun with an s unless count is one.
std::string counted(std::size_t count, const std::string& noun);

}  // namespace lumenline
