#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "engine/core/branches.h"
#include "engine/core/endpoints.h"
#include "engine/core/table.h"

namespace lumenline {

/// Distribution of a quantity along the own part of a branch, weighted by arc length. NaN where there is none.
struct Distribution {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    double mean = kNone, sd = kNone, min = kNone, p05 = kNone, p25 = kNone;
    double median = kNone, p75 = kNone, p95 = kNone, max = kNone;
};

/// One row per branch, in the order of their numbers. What cannot be computed is NaN.
struct BranchTable {
    std::vector<BranchId> parent;           ///< by which its first node was reached; none = from an inlet
    std::vector<std::uint32_t> generation;  ///< branches on the way from the inlet
    std::vector<std::uint32_t> line_count;  ///< centerlines that run through it
    std::vector<double> order_margin;       ///< as BranchCourse::order_margin
    std::vector<double> length;             ///< from node to node [length]
    std::vector<double> own_length;         ///< without the parts in junctions [length]
    std::vector<double> chord;              ///< straight from node to node [length]
    std::vector<double> length_over_chord;  ///< L/D
    std::vector<double> tortuosity;         ///< L/D - 1
    std::vector<double> taper;              ///< slope of the radius over the abscissa
    std::vector<Distribution> radius;       ///< of the inscribed ball [length]
    std::vector<Distribution> area;         ///< of closed sections [length^2]
    std::vector<Distribution> curvature;    ///< [1/length]
    std::vector<Distribution> torsion;      ///< [1/length]
    std::vector<double> wall_area;          ///< of the wall whose c(p) is in the own part [length^2]
    std::vector<double> volume;             ///< between that wall and the axis [length^3]
    std::vector<double> geodesic_distance, euclidean_distance;  ///< mean over that wall, by area [length]
    std::vector<double> normalized_tangency_deviation;          ///< mean over that wall, by area
};

/// Plane sections across the axes, one row each, branch by branch.
struct SectionTable {
    std::vector<BranchId> branch;
    std::vector<double> abscissa;                    ///< of the branch [length]
    std::vector<double> relative;                    ///< the same over the length of the branch, 0 to 1
    std::vector<Vec3> point, normal;                 ///< of the axis; unit, along it [length], [1]
    std::vector<double> area, perimeter;             ///< [length^2], [length]
    std::vector<double> equivalent_diameter;         ///< of the circle of the same area [length]
    std::vector<double> hydraulic_diameter;          ///< 4 area / perimeter [length]
    std::vector<double> min_diameter, max_diameter;  ///< shortest and longest chord through the centroid [length]
    std::vector<double> min_projection;              ///< least width over all orientations [length]
    std::vector<double> inscribed_diameter;          ///< twice the radius of the axis there [length]
    std::vector<double> circularity;                 ///< 4 pi area / perimeter^2
    std::vector<double> centroid_offset;             ///< from the point to the centroid of the section [length]
    std::vector<std::uint8_t> closed;                ///< 1: all of it is wall, not mostly of other branches

    [[nodiscard]] std::size_t rows() const { return branch.size(); }
};

/// Junctions, one row each. Angles in degrees.
struct BifurcationTable {
    std::vector<NodeId> node;
    std::vector<BranchId> parent, child_1, child_2;  ///< the children of lowest number
    std::vector<std::uint32_t> children;             ///< all branches there but the parent
    std::vector<Vec3> origin, normal;                ///< of the plane fitted to the directions of the three branches
    std::vector<double> angle_1, angle_2;            ///< between parent and child, 0 = straight on
    std::vector<double> angle_between;               ///< between the children
    std::vector<double> in_plane_1, in_plane_2;      ///< of the child against the parent, within the plane
    std::vector<double> out_of_plane_parent, out_of_plane_1, out_of_plane_2;
    std::vector<double> planarity;  ///< angle between the parent and the plane of the two children
    std::vector<double> parent_diameter, diameter_1, diameter_2;  ///< at the origin, by their taper [length]
    std::vector<double> area_ratio, diameter_ratio_1, diameter_ratio_2, asymmetry, murray_exponent;

    [[nodiscard]] std::size_t rows() const { return node.size(); }
};

/// The branches at junctions but the parents, one row for each of their ends there, junction by junction.
struct ChildTable {
    std::vector<JunctionId> junction;
    std::vector<BranchId> parent, child;
    std::vector<std::uint8_t> at_last_node;               ///< 1: the child ends there, as one that closes a loop
    std::vector<double> angle, in_plane, out_of_plane;    ///< as in BifurcationTable
    std::vector<double> diameter, diameter_ratio, share;  ///< share of the children's squared diameters [length], [1]

    [[nodiscard]] std::size_t rows() const { return junction.size(); }
};

/// The narrowest place of each branch, one row per branch, against the radii that a healthy vessel would have.
struct StenosisTable {
    std::vector<double> abscissa;                            ///< of the branch [length]
    std::vector<double> diameter, area;                      ///< there [length], [length^2]
    std::vector<double> nascet_diameter, nascet_area;        ///< 1 - least / distal reference
    std::vector<double> ecst_diameter, ecst_area;            ///< 1 - least / estimated original lumen there
    std::vector<double> distal_reference, fitted_reference;  ///< diameters [length]
    std::vector<double> from, to, length;                    ///< where half of the narrowing is passed [length]
};

/// The widest place of each branch against the same fit, one row per branch.
struct DilationTable {
    std::vector<double> abscissa, diameter, fitted_reference;  ///< [length]
    std::vector<double> ratio, area_ratio;                     ///< largest / fitted
    std::vector<double> from, to, length;                      ///< where half of the widening is passed [length]
};

/// Coordinates of sites on the branches; NaN and none where a site has no centerline.
struct SurfaceBranches {
    std::vector<BranchId> branch;      ///< (N) of c(p)
    std::vector<JunctionId> junction;  ///< (N) none = the branch's own part
    std::vector<double> longitudinal;  ///< (N) abscissa of the branch at c(p) [length]
    std::vector<double> relative;      ///< (N) the same over the length of the branch, 0 to 1
    std::vector<double> angle;         ///< (N) around the axis from the frame, right-handed along it, (-pi, pi]
};

/// Means over patches: bins of the length of a branch by bins around it; one row each, around first.
struct PatchTable {
    std::vector<BranchId> branch;
    std::vector<std::uint32_t> along, around;  ///< bin, from 0
    std::vector<std::uint32_t> sites;          ///< in it
    std::vector<double> area;                  ///< of its wall [length^2]
    std::vector<double> distance;              ///< from the wall to the axis, as the next weighted by area [length]
    std::vector<double> geodesic_distance, euclidean_distance, normalized_tangency_deviation;
};

/// Everything that engine/branches finds of one model.
struct Branches : BranchAxes {
    BranchTable table;
    BifurcationTable bifurcations;
    ChildTable children;
    SectionTable sections;
    StenosisTable stenoses;
    DilationTable dilations;
    SurfaceBranches surface;  ///< empty where the surface is not characterized
    PatchTable patches;
};

/// The tables of a model with the definitions of their columns: branches, bifurcations, bifurcation_children, sections,
/// stenoses, dilations, patches. Without rows, their columns alone.
std::vector<Table> branch_tables(const Branches& branches);

/// endpoints: one row per endpoint.
Table endpoint_table(const Endpoints& endpoints, const BranchGraph& graph);

}  // namespace lumenline
