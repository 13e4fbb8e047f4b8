// The truth of a phantom is five tab-separated columns under a heading.
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/examples/promises.h"

namespace lumenline::examples {

AxisTruth read_truth(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::string line;
    if (!std::getline(in, line) || line != "abscissa\tx\ty\tz\tradius")
        throw std::runtime_error(file.string() + " is no truth of a phantom");
    AxisTruth truth;
    while (std::getline(in, line)) {
        std::istringstream row(line);
        double s = 0, r = 0;
        Vec3 p;
        if (!(row >> s >> p.x >> p.y >> p.z >> r)) throw std::runtime_error(file.string() + ": bad row " + line);
        truth.abscissa.push_back(s);
        truth.points.push_back(p);
        truth.radius.push_back(r);
    }
    if (truth.points.size() < 2) throw std::runtime_error(file.string() + " has no axis");
    return truth;
}

}  // namespace lumenline::examples
