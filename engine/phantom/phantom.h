#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

#include "engine/core/soup.h"
#include "engine/core/vec3.h"

namespace lumenline {

enum class PhantomKind : std::uint8_t {
    kCylinder,  ///< straight, elliptic section
    kTorus,     ///< arc of a torus, circular section
    kHelix,     ///< circular section
    kStenosis,  ///< straight, circular section with a Gaussian narrowing in the middle
    kHairpin,   ///< two parallel straight legs joined by half a torus, circular section
};

/// "cylinder" | "torus" | "helix" | "stenosis" | "hairpin"
std::string_view phantom_name(PhantomKind kind);

/// What to build. A field that the kind does not use is ignored, except that all kinds other than
/// the cylinder want a == b. Lengths are in units before `scale`, angles in radians.
struct PhantomOptions {
    PhantomKind kind = PhantomKind::kCylinder;
    double a = 5, b = 5;      ///< semi-axes of the section along e1, e2; stenosis: the healthy radius
    double length = 50;       ///< cylinder, stenosis: of the axis
    double bend_radius = 20;  ///< torus: major radius; helix: of the helix; hairpin: half the legs' distance
    double arc = 1.5 * std::numbers::pi;  ///< torus, helix: angle swept by the axis
    double pitch = 20;                    ///< helix: rise per turn; negative = left-handed
    double leg_length = 40;               ///< hairpin: of each leg
    double severity = 0.5;                ///< stenosis: largest reduction of the diameter, as a share
    double stenosis_width = 5;            ///< stenosis: radius(z) = a (1 - severity exp(-((z - length/2) / width)^2))
    int points_around = 40;               ///< vertices per ring
    double jitter = 0;                    ///< tangential, uniform in [-jitter, jitter] edges around and along
    double noise = 0;                     ///< Gaussian along the wall's normal, standard deviation in edges
    std::uint64_t seed = 1;               ///< of jitter and noise, which have separate streams
    bool caps = false;                    ///< closed by flat caps of concentric rings; else open ends
    bool rotate = false;                  ///< by a fixed rotation in general position
    Vec3 rotation_axis{0, 0, 1};          ///< a second rotation, applied after the fixed one
    double rotation_angle = 0;
    Vec3 offset;  ///< added after scaling
    double scale = 1;
    bool float32 = false;  ///< round the final coordinates to float32
};

/// Origin on the axis and right-handed unit vectors: tangent = cross(e1, e2).
struct AxisFrame {
    Vec3 origin, e1, e2, tangent;
};

/// Point of the analytic wall and the outward unit normal there.
struct WallPoint {
    Vec3 point, normal;
};

/// Exact geometry of a phantom, in its final placement and unit; knows nothing of the mesh, so
/// neither jitter, noise nor rounding change it. "Wall" is the surface without caps.
class PhantomTruth {
public:
    /// @throws std::invalid_argument for impossible geometry: a size that is not positive and
    ///         finite, a tube thicker than its bend, turns that overlap
    explicit PhantomTruth(const PhantomOptions& options = {});

    [[nodiscard]] double total_length() const { return scale_ * length_; }

    /// Axis and its rotation-minimising frame at abscissa `s`, clamped to [0, total_length()].
    [[nodiscard]] AxisFrame frame(double s) const;
    [[nodiscard]] Vec3 position(double s) const { return frame(s).origin; }
    [[nodiscard]] Vec3 tangent(double s) const { return frame(s).tangent; }

    /// origin + a(s) cos(theta) e1 + b(s) sin(theta) e2, with a(s), b(s) the section's semi-axes.
    [[nodiscard]] WallPoint wall_point(double s, double theta) const;

    /// Least distance from the axis point at `s` to the wall: the radius of the maximal inscribed
    /// ball. In a stenosis it is below the section's radius wherever that changes.
    [[nodiscard]] double inscribed_radius(double s) const;

    /// Distance to, and abscissa of, the nearest point of the axis (between its ends). Of several
    /// equally near points the abscissa is one of them.
    [[nodiscard]] double distance_to_axis(Vec3 point) const;
    [[nodiscard]] double abscissa_of(Vec3 point) const;

    /// Distance to the wall, positive inside. Beyond the ends the wall is taken to go on: a
    /// stenosis by its formula, every other shape straight.
    [[nodiscard]] double signed_distance(Vec3 point) const;

    /// Whether a point is within the wall and between the planes of the two ends.
    [[nodiscard]] bool inside(Vec3 point) const;

    /// Semi-axes of the section; of a stenosis, its healthy radius.
    [[nodiscard]] double max_section_radius() const;
    [[nodiscard]] double min_section_radius() const;

    /// Least distance between the walls of two different parts of the tube (legs of a hairpin,
    /// turns of a helix); +inf where no two parts face each other.
    [[nodiscard]] double wall_gap() const { return scale_ * gap_; }

private:
    [[nodiscard]] AxisFrame local_frame(double s) const;
    [[nodiscard]] double local_abscissa(Vec3 p) const;
    [[nodiscard]] Vec3 to_world(Vec3 direction) const;
    [[nodiscard]] Vec3 to_local(Vec3 point) const;
    [[nodiscard]] double clamped(double s) const;

    PhantomOptions shape_;
    double length_ = 0;  // of the axis, before scaling
    double gap_ = std::numeric_limits<double>::infinity();
    std::array<Vec3, 3> basis_{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};  // images of the local axes
    Vec3 offset_;
    double scale_ = 1;
};

/// A triangulated phantom, oriented outward.
struct Phantom {
    std::vector<Vec3> points;                             ///< rings from start to end, then cap points
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into points
    PhantomTruth truth;
    double edge_length = 0;  ///< perimeter of the (healthy) section / points_around, scaled
    bool float32 = false;    ///< the coordinates were rounded to float32
};

/// Rings of vertices on the analytic wall, equispaced in arc length around and along, each ring
/// turned by half a step against its neighbours, sqrt(3)/2 edges apart (rounded to fill the axis).
/// Jitter moves vertices within the wall, those of the two end rings only around. Noise moves them
/// along the normal, in the end rings within their planes; cap points get none. The same options
/// give the same phantom on every platform, up to the last bits of its math library.
///
/// @throws std::invalid_argument as PhantomTruth, and for fewer than 3 points around, jitter above
///         0.4, a mesh that folds (jitter of 0.2 has not been seen to, 0.4 often does), noise that
///         would let walls touch, or more vertices than 32 bits hold
/// @cost O(vertices)
Phantom make_phantom(const PhantomOptions& options);

/// The phantom as a reader would have returned it; source_file is "phantom".
TriangleSoup to_soup(const Phantom& phantom);

}  // namespace lumenline
