#pragma once

#include <vector>

#include "engine/core/surface.h"
#include "engine/geometry/curved_surface.h"
#include "engine/geometry/surface_distance.h"
#include "engine/trace/polyline.h"
#include "engine/trace/ridge.h"

namespace lumenline {

/// A path moved off the complex to the medial axis of the curved surface.
struct RefinedLine {
    Polyline line;                           ///< with the distance to the curved surface as radius
    std::vector<double> path_abscissa;       ///< per point: the path's abscissa it corresponds to, ascending [length]
    std::vector<double> radius_error;        ///< per point: estimated error of the radius [length]
    std::vector<double> position_error;      ///< per point: estimated distance from the true line [length]
    double cost_before = 0, cost_after = 0;  ///< of path and line, by distances to the curved surface
    double noise = 0;          ///< how far the wall is expected to be off, in radii: median over the nodes
    double largest_stray = 0;  ///< largest distance of a node from where it started, in radii there
};

/// An end of a path to be refined.
struct LineEnd {
    bool free = false;  ///< moves in the plane of `direction`, as beyond an opening; else it stays
    Vec3 direction;     ///< of the line there, unit, from start to end of the line; for free ends
};

/// Refines lines of one surface. Serves one thread.
class MedialRefiner {
public:
    MedialRefiner(const Surface& surface, const SurfaceDistance& flat) : curved_(surface, flat) {}

    /// The line of least cost near a path: nodes resampled along the path at half an edge's distance,
    /// moved in their sections until the cost, with distances to the curved surface, is least.
    /// Where it begins like an earlier one, up to a share of the radius, it takes over what was refined then.
    /// @returns a line without points where the path is too short or no step could be made
    [[nodiscard]] RefinedLine refine(const Polyline& path, const LineEnd& start, const LineEnd& end);

    /// Distance to the curved surface, looked for in all directions across a line.
    /// @param tangent  of the line, unit @param about  the distance, roughly @cost 24 distance queries
    [[nodiscard]] double radius_at(Vec3 x, Vec3 tangent, double about);

private:
    static constexpr std::size_t kDirections = 12;

    /// A place of the wall in one direction from a node.
    struct Contact {
        Vec3 flat;  ///< on the flat surface, where the next search starts
        TriangleId triangle;
        SurfaceFoot foot;
    };
    /// A point of the curve between two nodes.
    struct Between {
        Vec3 x;
        double radius = 0;  ///< [length]
        double share = 0;   ///< of the way to the second node
    };
    struct Node {
        Vec3 tangent;
        Vec3 start;  ///< on the path
        double path_abscissa = 0, path_radius = 0;
        double radius = 0;  ///< distance to the nearest place known [length]
        double reach = 0;
        double moved = 0;                 ///< in the last round [length]
        bool frozen = false;              ///< of a stretch refined with an earlier line
        std::vector<Between> between;     ///< of the curve from it to the next node
        std::vector<Contact> around;      ///< one per direction
        std::vector<SurfaceFoot> own;     ///< its own feet
        std::vector<SurfaceFoot> before;  ///< those of earlier rounds
        Vec3 flat;                        ///< nearest point of the flat surface
        TriangleId triangle;
        double uncertainty = 0, radius_error = 0, position_error = 0;  ///< [length]
    };

    /// What the places around some nodes tell of the wall there; sums, to be divided by `weight`.
    struct Section {
        double weight = 0;
        double offset2 = 0;     ///< squares of the sites' heights above where their neighbours would put them
        double product = 0;     ///< of the heights of sites that share an edge
        double edge2 = 0;       ///< squares of edges
        double mean2 = 0;       ///< squares of the mean height around the section
        double first2 = 0;      ///< squares of the amplitude of the height's first harmonic around the section
        double anisotropy = 0;  ///< 1 - (b / a)^2 of the section's conic, 0 where it is round

        void add(const Section& other, double factor);
    };

    /// A line refined before.
    struct Finished {
        Polyline path;
        std::vector<RidgeNode> ridge;
        std::vector<Node> nodes;
    };

    /// Takes over what an earlier line has refined of the path's beginning.
    void take_over(const Polyline& path);
    void resample(const Polyline& path, const LineEnd& start, const LineEnd& end);
    void make_sections(const LineEnd& start, const LineEnd& end);
    void find_around(std::size_t node, bool search);
    void find_own_feet(std::size_t node);
    void find_places(int round);
    void set_bounds(bool all, std::size_t shared);
    void set_bounds(std::size_t node, std::size_t shared);
    void add_bound(const RidgeNode& ridge, const SurfaceFoot& foot, bool curved);
    double move_nodes();
    void estimate_errors();
    [[nodiscard]] double noise_level() const;
    [[nodiscard]] Section section(std::size_t node);
    void set_errors(Node& node, const Section& mean) const;
    /// Distance from x, near the node, to the nearest of the places known.
    [[nodiscard]] double radius_known(std::size_t node, Vec3 x, std::size_t shared) const;
    /// Of the line through the nodes, or through where they started, both by the places known now.
    [[nodiscard]] double cost(bool at_start) const;
    void fill_in(std::size_t node);
    void append(const RidgeNode& ridge, const Node& node, const Node* next, RefinedLine& result) const;

    CurvedSurface curved_;
    RidgeProblem problem_;
    std::vector<Node> nodes_;
    std::vector<Finished> finished_;
    const Finished* shared_with_ = nullptr;  // earlier line that the path begins with
    double accuracy_ = 0, rest_ = 0;         // of the radius, for the line at hand
    std::size_t shared_nodes_ = 0;           // nodes of it that come before nodes_
};

}  // namespace lumenline
