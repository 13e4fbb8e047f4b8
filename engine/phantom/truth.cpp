// Exact geometry of the phantoms. Everything is computed in a local placement (straight shapes
// along z from the origin; torus and helix around z; hairpin in the plane y = 0, bend on top) and
// moved by one similarity. All curved shapes have circular sections and a tube thinner than the
// reach of its axis, hence the distance to the wall is radius - distance to the axis, and the
// inscribed radius is the tube's. Reach of the helix: the smaller of its radius of curvature and
// half its least doubly critical self-distance (Litherland et al. 1999), which by symmetry is a
// local minimum of the chord over the swept angle. A stenosis is a surface of revolution: its
// distances are minima over the meridian, which may have several local ones, hence the scans.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "engine/core/text.h"
#include "engine/phantom/minimum.h"
#include "engine/phantom/phantom.h"
#include "engine/phantom/section.h"

namespace lumenline {
namespace {

using std::numbers::pi;
using Basis = std::array<Vec3, 3>;

Vec3 apply(const Basis& basis, Vec3 v) { return v.x * basis[0] + v.y * basis[1] + v.z * basis[2]; }

bool is_straight(PhantomKind kind) { return kind == PhantomKind::kCylinder || kind == PhantomKind::kStenosis; }

[[noreturn]] void reject(const PhantomOptions& o, const std::string& reason) {
    throw std::invalid_argument("impossible " + std::string(phantom_name(o.kind)) + ": " + reason);
}

void require_positive(const PhantomOptions& o, double value, const std::string& name) {
    if (!(value > 0 && std::isfinite(value))) reject(o, name + " is " + short_text(value) + ", must be positive");
}

double rise_per_radian(const PhantomOptions& o) { return o.pitch / (2 * pi); }

double helix_speed(const PhantomOptions& o) { return std::hypot(o.bend_radius, rise_per_radian(o)); }

// Length of the chord between two axis points of a helix that lie an angle apart.
double helix_chord(const PhantomOptions& o, double angle) {
    return std::hypot(2 * o.bend_radius * std::sin(0.5 * angle), rise_per_radian(o) * angle);
}

// Least distance between axis points of different turns; +inf if the helix sweeps too little, or
// rises too steeply, for its chord to shrink again. The chord's square has the slope 2 R^2 h with
// h(angle) = sin(angle) + (c/R)^2 angle; h is convex between pi and 2 pi.
double helix_turn_distance(const PhantomOptions& o) {
    const double k = std::pow(rise_per_radian(o) / o.bend_radius, 2);
    const auto h = [&](double angle) { return std::sin(angle) + k * angle; };
    if (k >= 1) return std::numeric_limits<double>::infinity();
    const double lowest = 2 * pi - std::acos(-k);
    if (h(lowest) >= 0) return std::numeric_limits<double>::infinity();
    const auto rising = [&](double angle) { return Jet{0, h(angle), std::cos(angle) + k}; };
    const auto falling = [&](double angle) { return Jet{0, -h(angle), -std::cos(angle) - k}; };
    const double farthest = stationary_point(falling, pi, lowest);
    const double nearest = stationary_point(rising, lowest, 2 * pi);
    if (o.arc <= farthest) return std::numeric_limits<double>::infinity();
    return helix_chord(o, std::min(o.arc, nearest));
}

void check_bend(const PhantomOptions& o) {
    require_positive(o, o.bend_radius, "bend radius");
    double limit = o.bend_radius;
    if (o.kind == PhantomKind::kHelix) limit = std::pow(helix_speed(o), 2) / o.bend_radius;
    if (!(o.a < limit)) {
        reject(o, "tube radius " + short_text(o.a) + " must be less than the axis' radius of curvature " +
                      short_text(limit));
    }
}

// Checks the shape and returns {length of the axis, gap between facing walls}.
std::pair<double, double> measure(const PhantomOptions& o) {
    constexpr double kNoGap = std::numeric_limits<double>::infinity();
    require_positive(o, o.a, "semi-axis a");
    require_positive(o, o.b, "semi-axis b");
    require_positive(o, o.scale, "scale");
    if (o.kind != PhantomKind::kCylinder && o.a != o.b) {
        reject(o, "its section is a circle, but a = " + short_text(o.a) + " and b = " + short_text(o.b));
    }
    switch (o.kind) {
        case PhantomKind::kCylinder: require_positive(o, o.length, "length"); return {o.length, kNoGap};
        case PhantomKind::kStenosis:
            require_positive(o, o.length, "length");
            require_positive(o, o.stenosis_width, "stenosis width");
            if (!(o.severity >= 0 && o.severity < 1)) {
                reject(o, "severity is " + short_text(o.severity) + ", must be at least 0 and less than 1");
            }
            return {o.length, kNoGap};
        case PhantomKind::kTorus:
            check_bend(o);
            if (!(o.arc > 0 && o.arc < 2 * pi)) {
                reject(o, "arc is " + short_text(o.arc) + " rad, must be positive and less than a full turn");
            }
            return {o.bend_radius * o.arc, kNoGap};
        case PhantomKind::kHelix: {
            require_positive(o, o.arc, "arc");
            if (!std::isfinite(o.pitch)) reject(o, "pitch is " + short_text(o.pitch));
            check_bend(o);
            const double between = helix_turn_distance(o);
            if (!(2 * o.a < between)) {
                reject(o, "pitch " + short_text(o.pitch) + " brings turns of the axis to within " +
                              short_text(between) + ", must be more than the tube's diameter " + short_text(2 * o.a));
            }
            return {helix_speed(o) * o.arc, between - 2 * o.a};
        }
        case PhantomKind::kHairpin:
            check_bend(o);
            require_positive(o, o.leg_length, "leg length");
            return {2 * o.leg_length + pi * o.bend_radius, 2 * (o.bend_radius - o.a)};
    }
    reject(o, "unknown kind");
}

Basis rotation_of(const PhantomOptions& o) {
    Basis basis{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    if (o.rotate) {
        basis[2] = normalized({0.3, 0.5, 0.8});
        basis[0] = normalized(cross(basis[2], {0.1, 0.9, -0.2}));
        basis[1] = cross(basis[2], basis[0]);
    }
    if (o.rotation_angle != 0) {
        const Vec3 axis = normalized(o.rotation_axis);
        const double c = std::cos(o.rotation_angle);
        const double s = std::sin(o.rotation_angle);
        for (Vec3& v : basis) v = c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;  // Rodrigues
    }
    return basis;
}

// Meridian r(z) of a stenosis with its derivatives.
Jet meridian(const PhantomOptions& o, double z) {
    const double q = (z - 0.5 * o.length) / o.stenosis_width;
    const double bump = o.a * o.severity * std::exp(-q * q);
    const double w = o.stenosis_width;
    return {o.a - bump, 2 * q * bump / w, (2 - 4 * q * q) * bump / (w * w)};
}

// Distance of a point at (z, rho) to the whole meridian. The nearest point is no farther away
// along z than the wall straight above, which bounds the scan; its step resolves the narrowing.
double meridian_distance(const PhantomOptions& o, double z, double rho) {
    const double bound = std::fabs(meridian(o, z).value - rho);
    if (bound == 0) return 0;
    const auto half_square = [&](double x) {
        const Jet r = meridian(o, x);
        const double up = rho - r.value;
        return Jet{0.5 * ((x - z) * (x - z) + up * up), (x - z) - up * r.first, 1 + r.first * r.first - up * r.second};
    };
    const int steps = static_cast<int>(std::clamp(std::ceil(32 * bound / o.stenosis_width), 32.0, 65536.0));
    const double x = scanned_minimum(half_square, z - bound, z + bound, steps);
    return std::hypot(x - z, rho - meridian(o, x).value);
}

}  // namespace

std::string_view phantom_name(PhantomKind kind) {
    static constexpr std::array<std::string_view, 5> kNames{"cylinder", "torus", "helix", "stenosis", "hairpin"};
    return kNames.at(static_cast<std::size_t>(kind));
}

PhantomTruth::PhantomTruth(const PhantomOptions& options) : shape_(options) {
    std::tie(length_, gap_) = measure(options);
    for (const double x : {options.offset.x, options.offset.y, options.offset.z, options.rotation_angle}) {
        if (!std::isfinite(x)) reject(options, "offset and rotation angle must be finite");
    }
    const double axis_length = norm(options.rotation_axis);
    if (!(axis_length > 0 && std::isfinite(axis_length))) reject(options, "the rotation axis has no direction");
    basis_ = rotation_of(options);
    offset_ = options.offset;
    scale_ = options.scale;
}

Vec3 PhantomTruth::to_world(Vec3 direction) const { return apply(basis_, direction); }

Vec3 PhantomTruth::to_local(Vec3 point) const {
    const Vec3 p = (1 / scale_) * (point - offset_);
    return {dot(p, basis_[0]), dot(p, basis_[1]), dot(p, basis_[2])};
}

double PhantomTruth::clamped(double s) const { return std::clamp(s / scale_, 0.0, length_); }

AxisFrame PhantomTruth::local_frame(double s) const {
    const double r = shape_.bend_radius;
    switch (shape_.kind) {
        case PhantomKind::kCylinder:
        case PhantomKind::kStenosis: break;
        case PhantomKind::kTorus: {
            const double c = std::cos(s / r);
            const double n = std::sin(s / r);
            return {{r * c, r * n, 0}, {c, n, 0}, {0, 0, -1}, {-n, c, 0}};
        }
        case PhantomKind::kHelix: {
            const double rise = rise_per_radian(shape_);
            const double speed = helix_speed(shape_);
            const double angle = s / speed;
            const double c = std::cos(angle);
            const double n = std::sin(angle);
            const Vec3 tangent{-r / speed * n, r / speed * c, rise / speed};
            const Vec3 normal{-c, -n, 0};
            const Vec3 binormal = cross(tangent, normal);
            const double turned = -rise / (speed * speed) * s;  // undoes the torsion
            return {{r * c, r * n, rise * angle},
                    std::cos(turned) * normal + std::sin(turned) * binormal,
                    std::cos(turned) * binormal - std::sin(turned) * normal,
                    tangent};
        }
        case PhantomKind::kHairpin: {
            const double t = s - shape_.leg_length;
            if (t <= 0) return {{r, 0, t}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
            if (t >= pi * r) return {{-r, 0, pi * r - t}, {-1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
            const double c = std::cos(t / r);
            const double n = std::sin(t / r);
            return {{r * c, 0, r * n}, {c, 0, n}, {0, 1, 0}, {-n, 0, c}};
        }
    }
    return {{0, 0, s}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

AxisFrame PhantomTruth::frame(double s) const {
    const AxisFrame f = local_frame(clamped(s));
    return {offset_ + scale_ * to_world(f.origin), to_world(f.e1), to_world(f.e2), to_world(f.tangent)};
}

WallPoint PhantomTruth::wall_point(double s, double theta) const {
    const AxisFrame f = local_frame(clamped(s));
    double a = shape_.a;
    double b = shape_.b;
    double slope = 0;
    if (shape_.kind == PhantomKind::kStenosis) {
        const Jet r = meridian(shape_, f.origin.z);
        a = b = r.value;
        slope = r.first;
    }
    const double c = std::cos(theta);
    const double n = std::sin(theta);
    const Vec3 local = f.origin + (a * c) * f.e1 + (b * n) * f.e2;
    const Vec3 normal = normalized((b * c) * f.e1 + (a * n) * f.e2 - (a * slope) * f.tangent);
    return {offset_ + scale_ * to_world(local), to_world(normal)};
}

double PhantomTruth::inscribed_radius(double s) const {
    if (shape_.kind == PhantomKind::kStenosis) return scale_ * meridian_distance(shape_, clamped(s), 0);
    return scale_ * std::min(shape_.a, shape_.b);
}

double PhantomTruth::local_abscissa(Vec3 p) const {
    const double r = shape_.bend_radius;
    switch (shape_.kind) {
        case PhantomKind::kCylinder:
        case PhantomKind::kStenosis: break;
        case PhantomKind::kTorus: {
            double angle = std::atan2(p.y, p.x);
            if (angle < 0) angle += 2 * pi;
            if (angle > shape_.arc) angle = angle - shape_.arc < 2 * pi - angle ? shape_.arc : 0;
            return std::min(r * angle, length_);
        }
        case PhantomKind::kHelix: {
            const double rise = rise_per_radian(shape_);
            const double rho = std::hypot(p.x, p.y);
            const double direction = std::atan2(p.y, p.x);
            const auto half_square = [&](double angle) {
                const double up = p.z - rise * angle;
                const double turn = angle - direction;
                return Jet{0.5 * (rho * rho + r * r + up * up) - r * rho * std::cos(turn),
                           r * rho * std::sin(turn) - rise * up, r * rho * std::cos(turn) + rise * rise};
            };
            constexpr double kStepsPerRadian = 8;  // minima are about a turn apart
            const int steps = 2 + static_cast<int>(std::ceil(kStepsPerRadian * shape_.arc));
            return std::min(helix_speed(shape_) * scanned_minimum(half_square, 0, shape_.arc, steps), length_);
        }
        case PhantomKind::kHairpin: {
            const double leg = shape_.leg_length;
            const double bend = pi * r;
            double angle = std::atan2(p.z, p.x);
            if (angle < 0) angle = p.x < 0 ? pi : 0;
            const std::array<double, 3> feet{leg + std::clamp(p.z, -leg, 0.0), leg + r * angle,
                                             leg + bend - std::clamp(p.z, -leg, 0.0)};
            return *std::min_element(feet.begin(), feet.end(), [&](double s, double t) {
                return squared_norm(local_frame(s).origin - p) < squared_norm(local_frame(t).origin - p);
            });
        }
    }
    return std::clamp(p.z, 0.0, length_);
}

double PhantomTruth::abscissa_of(Vec3 point) const { return scale_ * local_abscissa(to_local(point)); }

double PhantomTruth::distance_to_axis(Vec3 point) const {
    const Vec3 p = to_local(point);
    return scale_ * distance(p, local_frame(local_abscissa(p)).origin);
}

double PhantomTruth::signed_distance(Vec3 point) const {
    const Vec3 p = to_local(point);
    if (shape_.kind == PhantomKind::kCylinder) return scale_ * ellipse_distance(shape_.a, shape_.b, p.x, p.y);
    if (shape_.kind == PhantomKind::kStenosis) {
        const double rho = std::hypot(p.x, p.y);
        const double d = meridian_distance(shape_, p.z, rho);
        return scale_ * (rho < meridian(shape_, p.z).value ? d : -d);
    }
    double nearest = distance(p, local_frame(local_abscissa(p)).origin);
    for (const bool at_end : {false, true}) {
        const AxisFrame f = local_frame(at_end ? length_ : 0);
        const Vec3 outward = at_end ? f.tangent : -f.tangent;
        const double along = dot(p - f.origin, outward);
        if (along > 0) nearest = std::min(nearest, norm(p - f.origin - along * outward));
    }
    return scale_ * (shape_.a - nearest);
}

bool PhantomTruth::inside(Vec3 point) const {
    const Vec3 p = to_local(point);
    if (is_straight(shape_.kind)) return p.z >= 0 && p.z <= length_ && signed_distance(point) > 0;
    const double s = local_abscissa(p);
    const AxisFrame f = local_frame(s);
    const double along = dot(p - f.origin, f.tangent);
    if ((s <= 0 && along < 0) || (s >= length_ && along > 0)) return false;
    return distance(p, f.origin) < shape_.a;
}

double PhantomTruth::max_section_radius() const { return scale_ * std::max(shape_.a, shape_.b); }

double PhantomTruth::min_section_radius() const { return scale_ * std::min(shape_.a, shape_.b); }

}  // namespace lumenline
