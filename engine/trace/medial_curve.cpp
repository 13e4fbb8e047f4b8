// The curve through the refined nodes: a cubic between two of them, with the tangents of circles through three. Radii
// between nodes are measured at the feet that the nodes have found.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/trace/medial.h"

namespace lumenline {

namespace {

constexpr double kSag = 4e-4;    // of the radius: of the line's pieces, as long as they are not too many
constexpr int kMostPieces = 4;   // of a segment
constexpr double kBeyond = 0.6;  // of the radius: where from the wall in each direction is sought

}  // namespace

double MedialRefiner::radius_at(Vec3 x, Vec3 tangent, double about) {
    const Vec3 u = any_perpendicular(tangent), v = cross(tangent, u);
    TriangleId triangle(std::size_t{0});
    Vec3 hint = curved_.surface().points[at(curved_.surface().triangles[0][0])];
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < kDirections; ++k) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(k) / kDirections;
        const Vec3 p = x + (kBeyond * about) * (std::cos(angle) * u + std::sin(angle) * v);
        const SurfaceDistance::Nearest wall = curved_.flat().nearest(p, hint, triangle);
        hint = wall.point;
        triangle = wall.triangle;
        const SurfaceFoot beyond = curved_.foot(p, wall.point, wall.triangle);
        least = std::min(least, distance(x, curved_.foot(x, beyond.point, beyond.triangle).point));
    }
    return least;
}

void MedialRefiner::append(const RidgeNode& ridge, const Node& node, const Node* next, RefinedLine& result) const {
    result.line.append(ridge.position, node.radius);
    result.path_abscissa.push_back(node.path_abscissa);
    result.radius_error.push_back(node.radius_error);
    result.position_error.push_back(node.position_error);
    if (next == nullptr) return;
    for (const Between& p : node.between) {
        result.line.append(p.x, p.radius);
        result.path_abscissa.push_back(std::lerp(node.path_abscissa, next->path_abscissa, p.share));
        result.radius_error.push_back(std::lerp(node.radius_error, next->radius_error, p.share));
        result.position_error.push_back(std::lerp(node.position_error, next->position_error, p.share));
    }
}

void MedialRefiner::fill_in(std::size_t i) {
    nodes_[i].between.clear();
    if (i == 0 || i + 2 >= nodes_.size()) return;
    const RidgeNode* node = &problem_.nodes[i];
    const Vec3 a = node[-1].position, b = node[0].position, c = node[1].position, d = node[2].position;
    const double ab = distance(a, b), bc = distance(b, c), cd = distance(c, d);
    if (!(ab > 0 && bc > 0 && cd > 0)) return;
    // Tangents of the circles through three nodes each, times the segment's length.
    const Vec3 at_b = (bc / (ab + bc)) * ((bc / ab) * (b - a) + (ab / bc) * (c - b));
    const Vec3 at_c = (bc / (bc + cd)) * ((cd / bc) * (c - b) + (bc / cd) * (d - c));
    const double sag = 0.125 * norm(at_b - at_c) / nodes_[i].radius;
    const int pieces = std::clamp(static_cast<int>(std::ceil(std::sqrt(sag / kSag))), 1, kMostPieces);
    for (int k = 1; k < pieces; ++k) {
        const double t = double{1} * k / pieces, u = 1 - t;
        const Vec3 x = lerp(b, c, t * t * (3 - 2 * t)) + (t * u * u) * at_b - (t * t * u) * at_c;
        const SurfaceFoot* nearest = nullptr;
        double least = std::numeric_limits<double>::infinity();
        const auto offer = [&](const SurfaceFoot& f) {
            const double r = distance(x, f.point);
            if (r >= least) return;
            least = r;
            nearest = &f;
        };
        for (const std::size_t j : {i, i + 1}) {
            for (const SurfaceFoot& f : nodes_[j].own) offer(f);
            for (const Contact& contact : nodes_[j].around) offer(contact.foot);
        }
        const double r = distance(x, curved_.foot(x, nearest->point, nearest->triangle).point);
        nodes_[i].between.push_back({x, std::min(r, least), t});
    }
}

}  // namespace lumenline
