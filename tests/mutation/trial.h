#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/soup.h"
#include "tests/mutation/damage.h"

namespace lumenline::mutation {

/// A clean surface and what `lumenline model` needs to know of it.
struct Subject {
    std::string name;
    TriangleSoup soup;
    std::vector<std::string> flags;  ///< endpoints of a closed surface
};

/// Eight small surfaces: phantoms, open and capped, and two of the examples.
const std::vector<Subject>& subjects();

struct Line {
    std::vector<Vec3> points;
    std::vector<double> radius;
};

/// How a run of the program on one file ended.
struct Outcome {
    int status = -1;      ///< exit status; -1 = a signal or the time limit ended it
    std::string died;     ///< of what
    std::string verdict;  ///< ok, warning or failed, from the model file; empty if there is none
    std::string failure;  ///< its failure code
    std::string error;    ///< standard error
    std::vector<Line> lines;
};

/// Runs `lumenline model` on `bytes` in a process of its own, killed after a minute.
Outcome run_model(const std::string& bytes, const std::string& format, const std::vector<std::string>& flags,
                  const std::filesystem::path& folder);

/// How far the lines of `clean` are from those of `other`, at most, per radius: each line from its nearest.
/// Infinite if `other` has none.
double deviation(const std::vector<Line>& clean, const std::vector<Line>& other);

/// "repaired", "other lines" or "refused: <code>" where that is allowed; else "WRONG: " and why.
std::string judge(const Damage& damage, const Outcome& outcome, const std::vector<Line>& clean);

/// Runs damage `d` on subject `s`.
std::string try_damage(std::size_t s, std::size_t d, const std::vector<Line>& clean,
                       const std::filesystem::path& folder);

/// Lines of the undamaged subject.
std::vector<Line> clean_lines(std::size_t s, const std::filesystem::path& folder);

}  // namespace lumenline::mutation
