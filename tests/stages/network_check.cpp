#include "tests/stages/network_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/stages/support.h"

namespace lumenline::test {

std::string network_fault(const Centerlines& lines) {
    std::vector<std::vector<std::size_t>> sides(lines.loops.size());
    for (std::size_t l = 0; l < lines.line_count(); ++l) {
        const std::string line = "line " + std::to_string(l);
        if (lines.loop[l].is_none() == lines.target[l].is_none()) return line + " has not one end";
        for (std::size_t k = lines.offsets[l]; k < lines.offsets[l + 1]; ++k)
            if (!(lines.clearance[k] > 0)) return line + " leaves the lumen";
        if (lines.loop[l].is_none()) continue;
        if (at(lines.loop[l]) >= sides.size()) return line + " is of no loop";
        sides[at(lines.loop[l])].push_back(l);
        if (lines.points[lines.offsets[l + 1] - 1] != lines.loops[at(lines.loop[l])].point)
            return line + " ends elsewhere than its loop";
    }
    for (std::size_t h = 0; h < sides.size(); ++h) {
        const std::string loop = "loop " + std::to_string(h);
        if (sides[h].size() != 2) return loop + " has " + std::to_string(sides[h].size()) + " lines";
        const std::size_t first = sides[h][0], second = sides[h][1];
        if (lines.source[first] != lines.loops[h].source) return loop + " starts at another source";
        const double radius = lines.loops[h].ball_radius;
        if (distance_between_lines(part(lines.points, lines.offsets, first),
                                   part(lines.points, lines.offsets, second)) < radius)
            return loop + " has one side twice";
    }
    return {};
}

double largest_distance_to_lines(const ModelRecord& record) {
    const Centerlines& lines = *record.centerlines;
    double largest = 0;
    for (std::size_t s = 0; s < record.surface->site_count(); ++s) {
        if (record.surface->origin[s] != SiteOrigin::kWall || record.character->zone[s] == SiteZone::kEndZone) continue;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < lines.points.size(); ++k)
            least = std::min(least, distance(record.surface->points[s], lines.points[k]) / lines.radius[k]);
        largest = std::max(largest, least);
    }
    return largest;
}

}  // namespace lumenline::test
