#include "engine/branches/measures.h"

#include <cmath>

#include "engine/branches/robust.h"

namespace lumenline {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Distribution distribution_on(const std::vector<double>& values, const OwnPart& part) {
    std::vector<std::pair<double, double>> weighted;
    for (std::size_t k = part.begin; k < part.end; ++k) weighted.emplace_back(values[k], part.weight[k - part.begin]);
    return distribution_of(std::move(weighted));
}

}  // namespace

OwnPart own_part(const BranchLines& axes, std::size_t branch) {
    OwnPart part;
    part.begin = axes.offsets[branch];
    part.end = axes.offsets[branch + 1];
    if (!(axes.own_to[branch] > axes.own_from[branch])) return {part.begin, part.begin, {}};
    if (axes.own_from[branch] > 0) ++part.begin;
    if (axes.own_to[branch] < axes.length(branch)) --part.end;
    part.weight.assign(part.end - part.begin, 0);
    for (std::size_t k = part.begin; k + 1 < part.end; ++k) {
        const double half = 0.5 * (axes.abscissa[k + 1] - axes.abscissa[k]);
        part.weight[k - part.begin] += half;
        part.weight[k + 1 - part.begin] += half;
    }
    return part;
}

BranchTable measure_axes(const GraphDraft& draft, const BranchLines& axes) {
    BranchTable t;
    const std::size_t count = draft.branches.size();
    for (std::size_t b = 0; b < count; ++b) {
        const BranchCourse& course = draft.branches[b];
        t.parent.push_back(course.parent == BranchCourse::kNone ? BranchId() : BranchId(course.parent));
        t.generation.push_back(static_cast<std::uint32_t>(course.generation));
        t.line_count.push_back(static_cast<std::uint32_t>(course.line_count));
        t.order_margin.push_back(course.order_margin);
        const double length = course.length();
        const double chord = distance(draft.graph.position[course.first], draft.graph.position[course.last]);
        t.length.push_back(length);
        t.own_length.push_back(course.own_length());
        t.chord.push_back(chord);
        t.length_over_chord.push_back(chord > 0 ? length / chord : kNaN);
        t.tortuosity.push_back(chord > 0 ? length / chord - 1 : kNaN);
        const OwnPart own = own_part(axes, b);
        const std::size_t points = own.end - own.begin;
        t.taper.push_back(
            repeated_median({axes.abscissa.data() + own.begin, points}, {axes.radius.data() + own.begin, points})
                .slope);
        t.radius.push_back(distribution_on(axes.radius, own));
        t.curvature.push_back(distribution_on(axes.curvature, own));
        t.torsion.push_back(distribution_on(axes.torsion, own));
    }
    t.area.resize(count);
    for (auto* column :
         {&t.wall_area, &t.volume, &t.geodesic_distance, &t.euclidean_distance, &t.normalized_tangency_deviation})
        column->assign(count, kNaN);
    return t;
}

void measure_areas(const SectionTable& sections, BranchTable& table) {
    std::vector<std::vector<std::pair<double, double>>> areas(table.area.size());
    for (std::size_t k = 0; k < sections.rows(); ++k)
        if (sections.closed[k] != 0) areas[at(sections.branch[k])].emplace_back(sections.area[k], 1.0);
    for (std::size_t b = 0; b < areas.size(); ++b) table.area[b] = distribution_of(std::move(areas[b]));
}

}  // namespace lumenline
