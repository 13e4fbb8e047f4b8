// Each site is taken to be off by as much as its neighbours would move it, with a sign drawn at random; what that
// does to the nodes follows from the solved problem's linear response (ridge.h). Sites shared by several nodes move
// them together, as they do in truth. Two things are not linear and are allowed for by factors, chosen on phantoms:
// the minimum over many places, and feet that slide along a sheet.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/trace/medial.h"

namespace lumenline {

namespace {

constexpr double kResolution = 2e-5;  // of the radius: how well nodes are found on a wall without error
// Where balls touch all around, the nearest of many uncertain places is nearer than each is expected to be; where they
// touch on two sides, their uncertainties pull the node along the sheet, farther than they lie apart.
constexpr double kCrowding = 0.5, kSlackness = 1.5;

}  // namespace

void MedialRefiner::estimate_errors() {
    solve_ridge(problem_, accuracy_, true);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        Node& node = nodes_[i];
        if (node.frozen) continue;
        const RidgeNode& ridge = problem_.nodes[i];
        const double sheet = sheet_likeness(i), sheet2 = sheet * sheet;
        node.radius_error = std::hypot(ridge.radius_response, node.uncertainty) * (1 + kCrowding * (1 - sheet2));
        node.position_error = ridge.move_response * (1 + kSlackness * sheet2) + kResolution * node.radius;
    }
}

double MedialRefiner::noise_level() const {
    std::vector<double> levels;
    for (const Node& node : nodes_)
        if (!node.frozen) levels.push_back(node.uncertainty / node.radius);
    const auto middle = levels.begin() + static_cast<std::ptrdiff_t>(levels.size() / 2);
    std::nth_element(levels.begin(), middle, levels.end());
    return *middle;
}

double MedialRefiner::sheet_likeness(std::size_t i) const {
    const RidgeNode& ridge = problem_.nodes[i];
    double a = 0, b = 0, c = 0;
    for (std::uint32_t k = ridge.first; k < ridge.last; ++k) {
        const auto& g = problem_.bounds[k].gradient;
        a += problem_.pressure[k] * g[0] * g[0];
        b += problem_.pressure[k] * g[0] * g[1];
        c += problem_.pressure[k] * g[1] * g[1];
    }
    return a + c > 0 ? std::hypot(a - c, 2 * b) / (a + c) : 0.0;
}

}  // namespace lumenline
