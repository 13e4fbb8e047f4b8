// Triangulation of the phantoms. The mesh is made in unit placement (rotated only) from the truth's
// own wall points, so that scale and offset are one rounding each, then scaled, moved, rounded.
// Neighbouring rings are zipped by the strip of fewest folded triangles and, among those, of least
// squared edges (Fuchs, Kedem, Uselton 1977), a shortest path in a band of the grid (vertex of one
// ring, vertex of the other). Greedy choices, by angle or by length, fold jittered rings.
#include "engine/phantom/phantom.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "engine/core/text.h"
#include "engine/phantom/mesh_soup.h"
#include "engine/phantom/random.h"
#include "engine/phantom/section.h"

namespace lumenline {
namespace {

using std::numbers::pi;
using Triangle = std::array<std::uint32_t, 3>;

constexpr double kMaxJitter = 0.4;   // rows are sqrt(3)/2 edges apart: beyond 0.43 two may meet
constexpr std::size_t kMaxLead = 4;  // edges by which the zipper may run ahead on one ring
constexpr double kMaxNoise = 0.5;
constexpr double kNoiseReach = 6;  // standard deviations that must fit into the space there is

// Consecutive vertices around the axis; share[i] is vertex i's place around in turns, ascending,
// less than one turn in all.
struct Ring {
    std::uint32_t first = 0;
    std::vector<double> share;

    [[nodiscard]] std::size_t size() const { return share.size(); }
    [[nodiscard]] std::uint32_t vertex(std::size_t i) const {
        return first + static_cast<std::uint32_t>(i % share.size());
    }
};

// State of the zipper: the cost of the best way there and which ring it advanced last.
struct Step {
    std::size_t folded = std::numeric_limits<std::size_t>::max();
    double length = 0;  // sum of squared edges between the rings
    bool along_a = false;

    void offer(const Step& from, bool faces_out, double edge, bool on_a) {
        const Step next{from.folded + (faces_out ? 0 : 1), from.length + edge, on_a};
        if (std::tie(next.folded, next.length) < std::tie(folded, length)) *this = next;
    }
};

struct Layout {
    double edge = 0;
    std::size_t rows = 0;
    double spacing = 0;  // of rows
};

[[noreturn]] void reject(const std::string& sentence) { throw std::invalid_argument(sentence); }

Layout plan(const PhantomOptions& o, const PhantomTruth& shape, double perimeter) {
    if (o.points_around < 3) reject("points around is " + std::to_string(o.points_around) + ", must be at least 3");
    Layout layout;
    layout.edge = perimeter / o.points_around;
    const double rows = std::max(1.0, std::round(shape.total_length() / (layout.edge * std::sqrt(0.75)))) + 1;
    // A cap has fewer vertices than as many rings of full size as there are around it.
    const double vertices = (rows + (o.caps ? o.points_around : 0)) * o.points_around + 2;
    constexpr double kMaxVertices = std::numeric_limits<std::uint32_t>::max();
    if (!(vertices < kMaxVertices)) {
        reject(short_text(vertices) + " vertices are more than 32-bit indices hold; use fewer points around");
    }
    layout.rows = static_cast<std::size_t>(rows);
    layout.spacing = shape.total_length() / (rows - 1);
    if (!(o.jitter >= 0 && o.jitter <= kMaxJitter)) {
        reject("jitter is " + short_text(o.jitter) + " edges, must be from 0 to " + short_text(kMaxJitter) +
               " or the mesh folds");
    }
    if (rows > 2 && !(2 * o.jitter * layout.edge < layout.spacing)) {
        reject("jitter " + short_text(o.jitter) + " lets rows of vertices meet, which are " +
               short_text(layout.spacing / layout.edge) + " edges apart; use less than half of that");
    }
    if (!(o.noise >= 0 && o.noise <= kMaxNoise)) {
        reject("noise is " + short_text(o.noise) + " edges, must be from 0 to " + short_text(kMaxNoise));
    }
    const double reach = kNoiseReach * o.noise * layout.edge;
    double room = 0.5 * shape.wall_gap();
    if (o.kind == PhantomKind::kStenosis) room = std::min(room, o.a * (1 - o.severity));
    room = std::min(room, shape.min_section_radius());
    if (o.noise > 0 && !(reach < room)) {
        reject("noise " + short_text(o.noise) + " lets walls touch: " + short_text(kNoiseReach, 1) +
               " standard deviations are " + short_text(reach) + ", must be less than " + short_text(room));
    }
    return layout;
}

class Mesher {
public:
    Mesher(const PhantomOptions& options, const PhantomTruth& shape)
        : options_(options),
          shape_(shape),
          arc_(options.a, options.b),
          layout_(plan(options, shape, arc_.perimeter())),
          jitter_(options.seed),
          noise_(~options.seed) {}

    void build() {
        Ring start = wall_ring(0);
        Ring last = start;
        for (std::size_t row = 1; row < layout_.rows; ++row) {
            Ring next = wall_ring(row);
            zip(last, next, {}, false);
            last = std::move(next);
        }
        if (!options_.caps) return;
        cap(std::move(start), 0);
        cap(std::move(last), shape_.total_length());
    }

    std::vector<Vec3> points;
    std::vector<Triangle> triangles;
    [[nodiscard]] double edge() const { return layout_.edge; }

private:
    std::uint32_t add(Vec3 point, Vec3 normal) {
        points.push_back(point);
        normals_.push_back(normal);
        return static_cast<std::uint32_t>(points.size() - 1);
    }

    Ring wall_ring(std::size_t row) {
        const bool is_end = row == 0 || row + 1 == layout_.rows;
        const double n = options_.points_around;
        const double abscissa = row + 1 == layout_.rows ? shape_.total_length() : row * layout_.spacing;
        Ring ring{static_cast<std::uint32_t>(points.size()), {}};
        for (int i = 0; i < options_.points_around; ++i) {
            const double around = options_.jitter * jitter_.symmetric();
            const double along = options_.jitter * jitter_.symmetric() * layout_.edge;
            const double share = (i + (row % 2 == 1 ? 0.5 : 0.0) + around) / n;
            const double s = is_end ? abscissa : abscissa + along;
            const WallPoint wall = shape_.wall_point(s, arc_.parameter(share));
            Vec3 normal = wall.normal;
            if (is_end) {
                const Vec3 tangent = shape_.tangent(s);
                normal = normalized(normal - dot(normal, tangent) * tangent);
            }
            const double height = options_.noise > 0 ? options_.noise * layout_.edge * noise_.normal() : 0.0;
            add(height != 0 ? wall.point + height * normal : wall.point, wall.normal);
            ring.share.push_back(share);
        }
        return ring;
    }

    // Flat cap at abscissa `s`: ever smaller copies of the section with ever fewer vertices, and a
    // fan in the middle.
    void cap(Ring rim, double s) {
        constexpr double kFewest = 6;
        const bool is_start = s == 0;
        const AxisFrame frame = shape_.frame(s);
        const Vec3 outward = is_start ? -frame.tangent : frame.tangent;
        const double rings = std::max(1.0, std::round(shape_.min_section_radius() / layout_.edge));
        for (double k = 1; k < rings; ++k) {
            const double factor = 1 - k / rings;
            const double n = std::max(kFewest, std::round(options_.points_around * factor));
            Ring next{static_cast<std::uint32_t>(points.size()), {}};
            for (double i = 0; i < n; ++i) {
                // Half the wall's jitter: cap rings have neighbours with other numbers of vertices.
                const double around = 0.5 * options_.jitter * jitter_.symmetric();
                const double share = (i + (std::fmod(k, 2) == 1 ? 0.5 : 0.0) + around) / n;
                add(lerp(frame.origin, shape_.wall_point(s, arc_.parameter(share)).point, factor), outward);
                next.share.push_back(share);
            }
            zip(rim, next, outward, is_start);
            rim = std::move(next);
        }
        const std::uint32_t centre = add(frame.origin, outward);
        for (std::size_t i = 0; i < rim.size(); ++i) push({rim.vertex(i), rim.vertex(i + 1), centre}, is_start);
    }

    void push(Triangle t, bool flipped) {
        if (flipped) std::swap(t[0], t[1]);
        triangles.push_back(t);
    }

    // Whether the triangle faces along `direction` or, if that is zero, along the wall's normals at
    // its corners.
    [[nodiscard]] bool faces_out(const Triangle& t, Vec3 direction, bool flipped) const {
        if (direction == Vec3{}) direction = normals_[t[0]] + normals_[t[1]] + normals_[t[2]];
        const double value = dot(cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]), direction);
        return flipped ? value < 0 : value > 0;
    }

    // Triangles between two rings around the same axis, `b` farther along it (or nearer to the
    // centre of a cap) than `a`. state(i, j): cheapest way to have passed i edges of `a` and j of `b`.
    void zip(const Ring& a, const Ring& b, Vec3 direction, bool flipped) {
        const std::size_t n = a.size();
        const std::size_t m = b.size();
        const std::size_t start = nearest_vertex(b, points[a.vertex(0)]);
        // A band of less than a whole ring: no two vertices are joined twice.
        const std::size_t lead = std::min(kMaxLead, (std::min(n, m) - 1) / 2);
        const std::size_t width = 2 * lead + 1;
        const auto even = [&](std::size_t i) { return (2 * i * m + n) / (2 * n); };  // i m / n, rounded
        steps_.assign((n + 1) * width, Step{});
        const auto state = [&](std::size_t i, std::size_t j) -> Step& {
            return steps_[i * width + (j + lead - even(i))];
        };
        const auto in_band = [&](std::size_t i, std::size_t j) {
            return j + lead >= even(i) && j <= even(i) + lead && j <= m;
        };
        state(0, 0) = {0, 0, false};
        for (std::size_t i = 0; i <= n; ++i) {
            for (std::size_t j = even(i) - std::min(even(i), lead); in_band(i, j); ++j) {
                const double edge = squared_norm(points[a.vertex(i)] - points[b.vertex(start + j)]);
                if (i > 0 && in_band(i - 1, j)) {
                    const Triangle t{a.vertex(i - 1), a.vertex(i), b.vertex(start + j)};
                    state(i, j).offer(state(i - 1, j), faces_out(t, direction, flipped), edge, true);
                }
                if (j > 0 && in_band(i, j - 1)) {
                    const Triangle t{a.vertex(i), b.vertex(start + j), b.vertex(start + j - 1)};
                    state(i, j).offer(state(i, j - 1), faces_out(t, direction, flipped), edge, false);
                }
            }
        }
        if (state(n, m).folded > 0) {
            reject("the mesh folds near " + short_text(points[a.vertex(0)]) +
                   " (before scale and offset); use less jitter or noise, more points around or another seed");
        }
        for (std::size_t i = n, j = m; i + j > 0;) {
            if (state(i, j).along_a) {
                push({a.vertex(i - 1), a.vertex(i), b.vertex(start + j)}, flipped);
                --i;
            } else {
                push({a.vertex(i), b.vertex(start + j), b.vertex(start + j - 1)}, flipped);
                --j;
            }
        }
    }

    [[nodiscard]] std::size_t nearest_vertex(const Ring& ring, Vec3 p) const {
        std::size_t best = 0;
        for (std::size_t i = 1; i < ring.size(); ++i) {
            if (squared_norm(points[ring.vertex(i)] - p) < squared_norm(points[ring.vertex(best)] - p)) best = i;
        }
        return best;
    }

    const PhantomOptions& options_;
    const PhantomTruth& shape_;
    EllipseArc arc_;
    Layout layout_;
    RandomStream jitter_;
    RandomStream noise_;
    std::vector<Vec3> normals_;  // outward, per point; of the wall on the rims
    std::vector<Step> steps_;    // scratch of zip
};

Vec3 rounded_to_float(Vec3 p) { return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}; }

}  // namespace

Phantom make_phantom(const PhantomOptions& options) {
    Phantom phantom;
    phantom.truth = PhantomTruth(options);
    PhantomOptions unplaced = options;
    unplaced.scale = 1;
    unplaced.offset = {};
    const PhantomTruth shape(unplaced);
    Mesher mesher(unplaced, shape);
    mesher.build();
    for (Vec3& p : mesher.points) {
        p = options.offset + options.scale * p;
        if (options.float32) p = rounded_to_float(p);
    }
    phantom.points = std::move(mesher.points);
    phantom.triangles = std::move(mesher.triangles);
    phantom.edge_length = options.scale * mesher.edge();
    phantom.float32 = options.float32;
    return phantom;
}

TriangleSoup mesh_soup(const std::vector<Vec3>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles,
                       double relative_rounding) {
    TriangleSoup soup;
    soup.points = points;
    soup.triangles = triangles;
    soup.source_file = "phantom";
    double largest = 0;
    for (const Vec3& p : points) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    soup.coordinate_rounding = relative_rounding * largest;
    return soup;
}

TriangleSoup to_soup(const Phantom& phantom) {
    return mesh_soup(phantom.points, phantom.triangles, phantom.float32 ? 0x1p-24 : 0x1p-53);
}

}  // namespace lumenline
