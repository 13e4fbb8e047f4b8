// The columns of the tables, each with its data dictionary entry, in the order in which the archive has them.
#include "engine/core/branch_tables.h"

#include <array>
#include <cstddef>

namespace lumenline {

namespace {

constexpr const char* kOurs = "";
constexpr const char* kVmtk = "Antiga & Steinman 2004, IEEE Trans Med Imaging 23:704";
constexpr const char* kNascet = "NASCET 1991, N Engl J Med 325:445";
constexpr const char* kEcst = "ECST 1991, Lancet 337:1235";
constexpr const char* kSiegel = "repeated median: Siegel 1982, Biometrika 69:242";
constexpr const char* kPaper = "Antiga, Ene-Iordache & Remuzzi 2003, section 2";
constexpr const char* kMurray = "Murray 1926, PNAS 12:207";

class Builder {
public:
    explicit Builder(const char* name) : table_{name, {}} {}

    Builder& add(const char* name, const char* unit, const char* definition, const char* source,
                 const std::vector<double>& values) {
        table_.columns.push_back({name, unit, definition, source, ColumnKind::kNumber, values, {}});
        return *this;
    }
    template <class Tag>
    Builder& add(const char* name, const char* definition, const std::vector<Index<Tag>>& values) {
        std::vector<double> numbers;
        numbers.reserve(values.size());
        for (const Index<Tag> i : values) numbers.push_back(i.is_none() ? -1.0 : static_cast<double>(i.value));
        return whole(name, definition, std::move(numbers));
    }
    template <class T>
    Builder& count(const char* name, const char* definition, const std::vector<T>& values) {
        return whole(name, definition, {values.begin(), values.end()});
    }
    Builder& whole(const char* name, const char* definition, std::vector<double> numbers) {
        table_.columns.push_back({name, "1", definition, kOurs, ColumnKind::kIndex, std::move(numbers), {}});
        return *this;
    }
    Builder& add(const std::array<const char*, 3>& names, const char* unit, const char* definition,
                 const std::vector<Vec3>& values) {
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<double> numbers;
            numbers.reserve(values.size());
            for (const Vec3& v : values) numbers.push_back(v[axis]);
            add(names[static_cast<std::size_t>(axis)], unit, definition, kOurs, numbers);
        }
        return *this;
    }
    /// Nine columns, one per statistic.
    Builder& add(const std::string& quantity, const char* unit, const std::string& definition,
                 const std::vector<Distribution>& values) {
        struct Statistic {
            const char *name, *words;
            double Distribution::*value;
        };
        static constexpr std::array<Statistic, 9> kStatistics{{{"mean", "mean", &Distribution::mean},
                                                               {"sd", "standard deviation", &Distribution::sd},
                                                               {"min", "least value", &Distribution::min},
                                                               {"p05", "5th percentile", &Distribution::p05},
                                                               {"p25", "lower quartile", &Distribution::p25},
                                                               {"median", "median", &Distribution::median},
                                                               {"p75", "upper quartile", &Distribution::p75},
                                                               {"p95", "95th percentile", &Distribution::p95},
                                                               {"max", "largest value", &Distribution::max}}};
        for (const Statistic& statistic : kStatistics) {
            std::vector<double> numbers;
            numbers.reserve(values.size());
            for (const Distribution& d : values) numbers.push_back(d.*statistic.value);
            table_.columns.push_back({quantity + "_" + statistic.name,
                                      unit,
                                      statistic.words + (" " + definition),
                                      kOurs,
                                      ColumnKind::kNumber,
                                      std::move(numbers),
                                      {}});
        }
        return *this;
    }
    Builder& text(const char* name, const char* definition, std::vector<std::string> values) {
        table_.columns.push_back({name, "1", definition, kOurs, ColumnKind::kText, {}, std::move(values)});
        return *this;
    }
    Table take() { return std::move(table_); }

private:
    Table table_;
};

std::vector<double> numbered(std::size_t count) {
    std::vector<double> numbers;
    for (std::size_t k = 0; k < count; ++k) numbers.push_back(static_cast<double>(k));
    return numbers;
}

Table table_of_branches(const Branches& b) {
    const BranchTable& t = b.table;
    std::vector<NodeId> first, last;
    std::vector<Vec3> direction;
    for (const auto& e : b.graph.edges) {
        first.push_back(e[0]);
        last.push_back(e[1]);
        const Vec3 chord = b.graph.position[at(e[1])] - b.graph.position[at(e[0])];
        direction.push_back((1 / norm(chord)) * chord);
    }
    return Builder("branches")
        .whole("branch_id", "number of the branch, level by level from the inlets; siblings by descending extent",
               numbered(t.length.size()))
        .add("parent", "branch by which the first node is reached; -1 = it starts at an inlet", t.parent)
        .add("first_node", "node of /graph where the branch starts", first)
        .add("last_node", "node of /graph where the branch ends", last)
        .count("generation", "branches between it and the inlet", t.generation)
        .count("line_count", "centerlines that run through it", t.line_count)
        .add("order_margin", "1",
             "least relative difference of its extent to that of a sibling next in order: how safe its number is; "
             "NaN = no sibling",
             kOurs, t.order_margin)
        .add("length", "length", "from node to node: own part and the straight ways to the nodes", kOurs, t.length)
        .add("own_length", "length", "arc length of the own part, without the parts in junctions", kVmtk, t.own_length)
        .add("own_from", "length", "abscissa where the own part starts", kVmtk, b.lines.own_from)
        .add("own_to", "length", "abscissa where the own part ends", kVmtk, b.lines.own_to)
        .add("chord", "length", "D: straight from node to node", kOurs, t.chord)
        .add({"direction_x", "direction_y", "direction_z"}, "1",
             "unit vector from the first node to the last; NaN where they are one place", direction)
        .add("length_over_chord", "1", "L/D", kOurs, t.length_over_chord)
        .add("tortuosity", "1", "L/D - 1", kOurs, t.tortuosity)
        .add("taper", "1", "slope of the radius over the abscissa in the own part", kSiegel, t.taper)
        .add("radius", "length", "of the maximal inscribed ball's radius along the own part, weighted by arc length",
             t.radius)
        .add("area", "length^2", "of the areas of the own part's closed sections", t.area)
        .add("curvature", "1/length",
             "of the axis's curvature along the own part, fitted in windows of branches.smoothing radii to either side",
             t.curvature)
        .add("torsion", "1/length",
             "of the axis's torsion where it is not straight, right-handed positive, fitted like the curvature",
             t.torsion)
        .add("wall_area", "length^2", "of the wall that belongs to the own part", kOurs, t.wall_area)
        .add("volume", "length^3", "between that wall and the axis", kOurs, t.volume)
        .add("geodesic_distance_mean", "length", "of D_g over that wall, weighted by area", kPaper, t.geodesic_distance)
        .add("euclidean_distance_mean", "length", "of D_e over that wall, weighted by area", kPaper,
             t.euclidean_distance)
        .add("normalized_tangency_deviation_mean", "1", "of NTD over that wall, weighted by area", kPaper,
             t.normalized_tangency_deviation)
        .take();
}

constexpr const char* kDiameter =
    "inscribed diameter at the origin: of the straight line fitted to the radii of the nearest ten radii of the own "
    "part; "
    "where that is shorter than the way to the origin, median of its nearest two radii";

Table table_of_bifurcations(const BifurcationTable& t) {
    return Builder("bifurcations")
        .whole("junction_id", "number of the junction", numbered(t.rows()))
        .add("node", "its node of /graph", t.node)
        .add("parent", "branch that comes to it first", t.parent)
        .add("child_1", "other branch there of lowest number", t.child_1)
        .add("child_2", "the next one", t.child_2)
        .count("children",
               "branch ends there but the parent's, all of which bifurcation_children has; here are the first two",
               t.children)
        .add({"origin_x", "origin_y", "origin_z"}, "length", "point nearest to the straight axes of its branches",
             t.origin)
        .add({"normal_x", "normal_y", "normal_z"}, "1",
             "unit normal of the plane fitted to the directions of parent, child_1 and child_2; child_1 lies counter-"
             "clockwise of the parent's direction",
             t.normal)
        .add("angle_1", "deg", "from the parent's direction to child_1's; 0 = straight on", kOurs, t.angle_1)
        .add("angle_2", "deg", "from the parent's direction to child_2's", kOurs, t.angle_2)
        .add("angle_between", "deg", "between the directions of child_1 and child_2", kOurs, t.angle_between)
        .add("in_plane_1", "deg", "from the parent's direction to child_1's, both projected into the plane", kVmtk,
             t.in_plane_1)
        .add("in_plane_2", "deg", "from the parent's direction to child_2's, both projected into the plane", kVmtk,
             t.in_plane_2)
        .add("out_of_plane_parent", "deg", "of the parent's direction out of the plane, along its normal", kVmtk,
             t.out_of_plane_parent)
        .add("out_of_plane_1", "deg", "of child_1's direction", kVmtk, t.out_of_plane_1)
        .add("out_of_plane_2", "deg", "of child_2's direction", kVmtk, t.out_of_plane_2)
        .add("planarity", "deg", "angle between the parent's direction and the plane of the two children; 0 = planar",
             kOurs, t.planarity)
        .add("parent_diameter", "length", kDiameter, kSiegel, t.parent_diameter)
        .add("diameter_1", "length", "the same of child_1", kSiegel, t.diameter_1)
        .add("diameter_2", "length", "the same of child_2", kSiegel, t.diameter_2)
        .add("area_ratio", "1", "sum of the squares of all children's diameters over the parent's", kOurs, t.area_ratio)
        .add("diameter_ratio_1", "1", "diameter of child_1 over the parent's", kOurs, t.diameter_ratio_1)
        .add("diameter_ratio_2", "1", "diameter of child_2 over the parent's", kOurs, t.diameter_ratio_2)
        .add("asymmetry", "1", "square of the smaller of diameter_1 and diameter_2 over the larger", kOurs, t.asymmetry)
        .add("murray_exponent", "1", "x in d^x = sum of the children's d^x; NaN where a child is as wide as the parent",
             kMurray, t.murray_exponent)
        .take();
}

Table table_of_children(const ChildTable& t) {
    return Builder("bifurcation_children")
        .add("junction_id", "number of the junction", t.junction)
        .add("parent", "branch that comes to it first", t.parent)
        .add("child", "another branch there; twice where both its ends are", t.child)
        .count("at_last_node", "0 = the child starts there; 1 = it ends there, as a branch that closes a loop",
               t.at_last_node)
        .add("angle", "deg", "from the parent's direction to the child's, away from the junction; 0 = straight on",
             kOurs, t.angle)
        .add("in_plane", "deg", "the same, both projected into the junction's plane", kVmtk, t.in_plane)
        .add("out_of_plane", "deg", "of the child's direction out of that plane, along its normal", kVmtk,
             t.out_of_plane)
        .add("diameter", "length", "as parent_diameter of bifurcations", kSiegel, t.diameter)
        .add("diameter_ratio", "1", "diameter over the parent's", kOurs, t.diameter_ratio)
        .add("area_share", "1", "square of the diameter over the sum of those of all children there", kOurs, t.share)
        .take();
}

Table table_of_sections(const SectionTable& t) {
    return Builder("sections")
        .add("branch_id", "branch that is cut", t.branch)
        .add("abscissa", "length", "of the branch", kOurs, t.abscissa)
        .add("abscissa_relative", "1", "the same over the branch's length, 0 to 1", kOurs, t.relative)
        .add({"point_x", "point_y", "point_z"}, "length", "point of the axis", t.point)
        .add({"normal_x", "normal_y", "normal_z"}, "1", "unit tangent of the axis: normal of the plane", t.normal)
        .add("area", "length^2", "of the component that holds the point", kOurs, t.area)
        .add("perimeter", "length", "of its boundary", kOurs, t.perimeter)
        .add("equivalent_diameter", "length", "of the circle of the same area", kOurs, t.equivalent_diameter)
        .add("hydraulic_diameter", "length", "4 area / perimeter", kOurs, t.hydraulic_diameter)
        .add("min_diameter", "length", "shortest chord through the centroid, in steps of 5 degrees", kOurs,
             t.min_diameter)
        .add("max_diameter", "length", "longest chord through the centroid, in steps of 5 degrees", kOurs,
             t.max_diameter)
        .add("min_projection", "length", "least width over all orientations: the minimum projection diameter", kPaper,
             t.min_projection)
        .add("inscribed_diameter", "length", "twice the radius of the maximal inscribed ball", kPaper,
             t.inscribed_diameter)
        .add("circularity", "1", "4 pi area / perimeter^2", kOurs, t.circularity)
        .add("centroid_offset", "length", "from the point to the section's centroid", kOurs, t.centroid_offset)
        .count("closed",
               "1 = its boundary is all wall, at most half of it of other branches; 0 = it is not, or was not found",
               t.closed)
        .take();
}

Table table_of_stenoses(const StenosisTable& t) {
    return Builder("stenoses")
        .whole("branch_id", "branch", numbered(t.abscissa.size()))
        .add("abscissa", "length", "of the branch where the radius is the least share of the fitted line", kOurs,
             t.abscissa)
        .add("diameter", "length", "twice the inscribed radius there", kOurs, t.diameter)
        .add("area", "length^2", "of the smaller one of the closed sections next to it", kOurs, t.area)
        .add("nascet_diameter", "1", "1 - diameter / distal_reference", kNascet, t.nascet_diameter)
        .add("nascet_area", "1", "1 - area / median area of the distal reference's sections", kNascet, t.nascet_area)
        .add("ecst_diameter", "1", "1 - diameter / fitted_reference", kEcst, t.ecst_diameter)
        .add("ecst_area", "1", "1 - area / that of the line fitted to the roots of the areas", kEcst, t.ecst_area)
        .add("distal_reference", "length",
             "median inscribed diameter over one to ten radii distal to twice the way to `to`; NaN = no such part",
             kNascet, t.distal_reference)
        .add("fitted_reference", "length", "diameter of the straight line fitted to the radii of the own part, there",
             kSiegel, t.fitted_reference)
        .add("from", "length", "abscissa before which less than half of the narrowing is left", kOurs, t.from)
        .add("to", "length", "abscissa behind which less than half of the narrowing is left", kOurs, t.to)
        .add("length", "length", "to - from", kOurs, t.length)
        .take();
}

Table table_of_dilations(const DilationTable& t) {
    return Builder("dilations")
        .whole("branch_id", "branch", numbered(t.abscissa.size()))
        .add("abscissa", "length", "of the branch where the radius is the largest multiple of the fitted line", kOurs,
             t.abscissa)
        .add("diameter", "length", "twice the inscribed radius there", kOurs, t.diameter)
        .add("fitted_reference", "length", "diameter of the straight line fitted to the radii of the own part, there",
             kSiegel, t.fitted_reference)
        .add("ratio", "1", "diameter / fitted_reference", kOurs, t.ratio)
        .add("area_ratio", "1", "square of ratio", kOurs, t.area_ratio)
        .add("from", "length", "abscissa before which less than half of the widening is left", kOurs, t.from)
        .add("to", "length", "abscissa behind which less than half of the widening is left", kOurs, t.to)
        .add("length", "length", "to - from", kOurs, t.length)
        .take();
}

Table table_of_patches(const PatchTable& t) {
    return Builder("patches")
        .add("branch_id", "branch", t.branch)
        .count("along", "bin of the relative abscissa, from the first node", t.along)
        .count("around", "bin of the angle, from 0 to 2 pi", t.around)
        .count("sites", "sites of the wall in it", t.sites)
        .add("area", "length^2", "of their share of the wall; NaN = no site", kOurs, t.area)
        .add("distance_mean", "length", "from the wall to the axis, weighted by area", kOurs, t.distance)
        .add("geodesic_distance_mean", "length", "of D_g, weighted by area", kPaper, t.geodesic_distance)
        .add("euclidean_distance_mean", "length", "of D_e, weighted by area", kPaper, t.euclidean_distance)
        .add("normalized_tangency_deviation_mean", "1", "of NTD, weighted by area", kPaper,
             t.normalized_tangency_deviation)
        .take();
}

}  // namespace

std::vector<Table> branch_tables(const Branches& b) {
    return {table_of_branches(b),          table_of_bifurcations(b.bifurcations), table_of_children(b.children),
            table_of_sections(b.sections), table_of_stenoses(b.stenoses),         table_of_dilations(b.dilations),
            table_of_patches(b.patches)};
}

Table endpoint_table(const Endpoints& endpoints, const BranchGraph& graph) {
    std::vector<Vec3> points;
    std::vector<double> radii;
    std::vector<std::string> kinds, roles;
    for (const Endpoint& e : endpoints) {
        points.push_back(e.point);
        radii.push_back(e.radius);
        kinds.emplace_back(kind_name(e.kind));
        roles.emplace_back(role_name(e.role));
    }
    std::vector<BranchId> branches(endpoints.size());
    for (std::size_t b = 0; b < graph.edges.size(); ++b)
        for (const NodeId n : graph.edges[b])
            if (const EndpointId e = graph.endpoint[at(n)]; !e.is_none() && at(e) < branches.size())
                branches[at(e)] = BranchId(b);
    return Builder("endpoints")
        .whole("endpoint", "number of the endpoint", numbered(endpoints.size()))
        .text("kind", "boundary | point | tip | cap", kinds)
        .text("role", "inlet (root of the tree) | outlet", roles)
        .add({"point_x", "point_y", "point_z"}, "length", "centre of the opening or cap, the given point, or the tip",
             points)
        .add("radius", "length", "of the opening's circle of equal area, or of the ball at a point or tip", kOurs,
             radii)
        .add("branch_id", "branch that starts or ends there; -1 = none", branches)
        .take();
}

}  // namespace lumenline
