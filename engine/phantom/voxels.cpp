// Cuberille surfaces (Herman and Liu 1979) of sampled phantoms. Faces join to a manifold if no two voxels
// of one kind meet in an edge or a corner alone ("well-composed", Latecki 1997): the image is made so by
// filling, which can only add and so comes to an end. Smoothing (Taubin 1995) takes turns between a step
// towards the mean of the neighbours and a slightly longer one away from it, so that tubes do not shrink;
// neighbours are those along the voxels' edges, since diagonals would favour one direction.
#include "engine/phantom/voxels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "engine/core/text.h"

namespace lumenline {
namespace {

constexpr double kMaxVoxels = 268435456;  // 2^28
constexpr int kMaxPasses = 1000;
constexpr double kShrink = 0.5, kGrow = -0.53;  // Taubin's lambda and mu: pass band up to 0.1
constexpr std::uint32_t kUnused = 0xFFFFFFFFU;

[[noreturn]] void reject(const std::string& sentence) { throw std::invalid_argument(sentence); }

using Cell = std::array<int, 3>;

/// A box of voxels, with a margin of two empty ones on every side.
class Grid {
public:
    Grid(const PhantomTruth& shape, double size) : size_(size) {
        Vec3 low = shape.position(0), high = low;
        const double length = shape.total_length();
        const double reach = shape.max_section_radius();
        const int steps = 2 + static_cast<int>(std::ceil(8 * length / reach));
        for (int k = 0; k <= steps; ++k) {
            const Vec3 p = shape.position(length * k / steps);
            for (int axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], p[axis]);
                high[axis] = std::max(high[axis], p[axis]);
            }
        }
        double count = 1;
        for (int axis = 0; axis < 3; ++axis) {
            // An eighth of a radius of the axis may pass between two samples.
            const double margin = 1.125 * reach + 2 * size;
            low_[axis] = low[axis] - margin;
            const double cells = std::ceil((high[axis] + margin - low_[axis]) / size);
            count *= cells;
            if (!(count <= kMaxVoxels)) {
                reject("voxels of " + short_text(size) + " make more than " + short_text(kMaxVoxels, 9) +
                       " in all; use larger ones");
            }
            cells_[static_cast<std::size_t>(axis)] = static_cast<int>(cells);
        }
        inside_.assign(static_cast<std::size_t>(count), 0);
        for (int i = 0; i < cells_[0]; i += kBlock)
            for (int j = 0; j < cells_[1]; j += kBlock)
                for (int k = 0; k < cells_[2]; k += kBlock) sample(shape, {i, j, k});
    }

    [[nodiscard]] bool inside(const Cell& c) const { return inside_[index(c)] != 0; }
    [[nodiscard]] Vec3 corner(const Cell& c) const {
        return low_ + size_ * Vec3{static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
    }
    [[nodiscard]] std::size_t index(const Cell& c) const {
        const auto [i, j, k] = c;
        return (static_cast<std::size_t>(i) * static_cast<std::size_t>(cells_[1]) + static_cast<std::size_t>(j)) *
                   static_cast<std::size_t>(cells_[2]) +
               static_cast<std::size_t>(k);
    }
    [[nodiscard]] std::size_t size() const { return inside_.size(); }

    /// Calls `body` for every voxel that has neighbours on all sides.
    template <class Body>
    void each(const Body& body) const {
        for (int i = 1; i + 1 < cells_[0]; ++i)
            for (int j = 1; j + 1 < cells_[1]; ++j)
                for (int k = 1; k + 1 < cells_[2]; ++k) body({i, j, k});
    }

    /// Fills voxels until none meet in an edge or a corner alone.
    void compose() {
        for (bool changed = true; changed;) {
            changed = false;
            each([&](const Cell& c) { changed = fill_edges(c) || fill_corner(c) || changed; });
        }
    }

private:
    static constexpr int kBlock = 8;

    /// Voxels of the block from `first`, unless it is too far from the axis to hold an inner point.
    void sample(const PhantomTruth& shape, const Cell& first) {
        const double half = 0.5 * kBlock * size_;
        const Vec3 centre = corner(first) + half * Vec3{1, 1, 1};
        if (shape.distance_to_axis(centre) > shape.max_section_radius() + std::sqrt(3.0) * half) return;
        for (int i = first[0]; i < std::min(first[0] + kBlock, cells_[0]); ++i)
            for (int j = first[1]; j < std::min(first[1] + kBlock, cells_[1]); ++j)
                for (int k = first[2]; k < std::min(first[2] + kBlock, cells_[2]); ++k)
                    inside_[index({i, j, k})] = shape.inside(corner({i, j, k}) + 0.5 * size_ * Vec3{1, 1, 1}) ? 1 : 0;
    }

    /// The voxel `steps` away (0 or 1 along each axis).
    static Cell shifted(Cell c, unsigned steps) {
        for (std::size_t axis = 0; axis < 3; ++axis) c[axis] += static_cast<int>(steps >> axis & 1U);
        return c;
    }

    bool fill_edges(const Cell& c) {
        bool changed = false;
        for (const auto& [u, v] : {std::pair{1U, 2U}, {2U, 4U}, {1U, 4U}}) {
            const std::array<Cell, 4> block{c, shifted(c, u), shifted(c, u | v), shifted(c, v)};
            const bool first = inside(block[0]), second = inside(block[1]);
            if (first == second || inside(block[2]) != first || inside(block[3]) != second) continue;
            inside_[index(block[first ? 1 : 0])] = 1;
            changed = true;
        }
        return changed;
    }

    bool fill_corner(const Cell& c) {
        for (unsigned corner = 0; corner < 4; ++corner) {
            const unsigned across = 7U ^ corner;
            const bool kind = inside(shifted(c, corner));
            bool alone = inside(shifted(c, across)) == kind;
            for (unsigned other = 0; other < 8 && alone; ++other)
                alone = other == corner || other == across || inside(shifted(c, other)) != kind;
            if (!alone) continue;
            // Of two inner voxels a neighbour joins them, of two outer ones one is filled.
            inside_[index(shifted(c, kind ? corner ^ 1U : corner))] = 1;
            return true;
        }
        return false;
    }

    double size_;
    Vec3 low_;
    Cell cells_{};
    std::vector<char> inside_;
};

struct Staircase {
    std::vector<Vec3> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::array<std::uint32_t, 4>> faces;  // the quads
};

Staircase surface_of(const Grid& grid) {
    Staircase surface;
    std::vector<std::uint32_t> number(grid.size(), kUnused);
    const auto vertex = [&](const Cell& c) {
        std::uint32_t& n = number[grid.index(c)];
        if (n == kUnused) {
            n = static_cast<std::uint32_t>(surface.points.size());
            surface.points.push_back(grid.corner(c));
        }
        return n;
    };
    grid.each([&](const Cell& c) {
        if (!grid.inside(c)) return;
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const int side : {0, 1}) {
                Cell next = c;
                next[axis] += side == 1 ? 1 : -1;
                if (grid.inside(next)) continue;
                const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
                Cell a = c;
                a[axis] += side;
                Cell b = a, d = a;
                ++b[u];
                ++d[v];
                Cell e = b;
                ++e[v];
                std::array<std::uint32_t, 4> face{vertex(a), vertex(b), vertex(e), vertex(d)};
                if (side == 0) std::swap(face[1], face[3]);
                // Diagonals alternate like a chessboard's colours, so that none of their directions prevails.
                const auto turn = static_cast<std::size_t>((c[0] + c[1] + c[2]) % 2);
                surface.triangles.push_back({face[turn], face[turn + 1], face[turn + 2]});
                surface.triangles.push_back({face[turn], face[turn + 2], face[(turn + 3) % 4]});
                surface.faces.push_back(face);
            }
    });
    return surface;
}

/// One step of all points by `share` of the way to the mean of their neighbours along faces' edges. Every
/// edge is in two faces, once in either direction.
void step(Staircase& surface, double share, std::vector<Vec3>& sum, std::vector<int>& count) {
    sum.assign(surface.points.size(), Vec3{});
    count.assign(surface.points.size(), 0);
    for (const auto& face : surface.faces)
        for (std::size_t k = 0; k < 4; ++k) {
            sum[face[k]] += surface.points[face[(k + 1) % 4]];
            ++count[face[k]];
        }
    for (std::size_t i = 0; i < surface.points.size(); ++i)
        surface.points[i] = lerp(surface.points[i], (1.0 / count[i]) * sum[i], share);
}

/// V - E + F of the quads: 2 for a sphere, less for handles, more for pieces.
long euler_of(const Staircase& surface) {
    return static_cast<long>(surface.points.size()) - static_cast<long>(surface.faces.size());
}

}  // namespace

Phantom make_voxel_phantom(const PhantomOptions& options, const VoxelOptions& voxels) {
    if (!(voxels.size > 0 && voxels.size <= 1)) {
        reject("voxel size is " + short_text(voxels.size) + " radii, must be positive and at most 1");
    }
    if (voxels.smoothing < 0 || voxels.smoothing > kMaxPasses) {
        reject("smoothing is " + std::to_string(voxels.smoothing) + " passes, must be from 0 to " +
               std::to_string(kMaxPasses));
    }
    Phantom phantom;
    phantom.truth = PhantomTruth(options);
    PhantomOptions unplaced = options;
    unplaced.scale = 1;
    unplaced.offset = {};
    const PhantomTruth shape(unplaced);
    const double size = voxels.size * shape.min_section_radius();
    if (!(shape.wall_gap() >= 2 * size)) {
        reject("voxels of " + short_text(size) + " do not part walls that are " + short_text(shape.wall_gap()) +
               " from each other; use voxels of at most half of that");
    }
    Grid grid(shape, size);
    grid.compose();
    Staircase surface = surface_of(grid);
    if (euler_of(surface) != 2) {
        reject("voxels of " + short_text(size) + " leave the shape in pieces; use smaller ones");
    }
    std::vector<Vec3> sum;
    std::vector<int> count;
    for (int pass = 0; pass < voxels.smoothing; ++pass) {
        step(surface, kShrink, sum, count);
        step(surface, kGrow, sum, count);
    }
    for (Vec3& p : surface.points) {
        p = options.offset + options.scale * p;
        if (options.float32) p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    }
    phantom.points = std::move(surface.points);
    phantom.triangles = std::move(surface.triangles);
    phantom.edge_length = options.scale * size;
    phantom.float32 = options.float32;
    return phantom;
}

}  // namespace lumenline
