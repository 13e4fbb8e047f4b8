// A walk starts from a site whose point c(p) is next to the section, or from the section before. It may come to
// another part of the wall that the plane passes through; then the next site is tried, and in the end all triangles.
//
// Next to a junction a plane across a narrow or oblique branch may pass through its mouth and on through the parent:
// the loop goes around the axis, but what it encloses is mostly the lumen of another vessel.
#include "engine/branches/sections.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/branches/axes.h"
#include "engine/branches/measures.h"
#include "engine/core/text.h"

namespace lumenline {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kTries = 6;
constexpr double kOfOthers = 0.5;  // of a boundary, at most, is wall of other branches

/// Sites of one branch by their abscissa.
using SitesAlong = std::vector<std::pair<double, SiteId>>;

/// One row.
struct Section {
    double abscissa = 0;
    SectionPlane plane;
    double radius = 0;  ///< of the axis [length]
    bool found = false, closed = false;
    SectionMeasures measures;
};

std::vector<double> stations(const BranchLines& axes, std::size_t branch, double step_radii) {
    const OwnPart own = own_part(axes, branch);
    if (own.begin == own.end) return {};
    double sum = 0, length = 0;
    std::size_t narrowest = own.begin;
    for (std::size_t k = own.begin; k < own.end; ++k) {
        sum += own.weight[k - own.begin] * axes.radius[k];
        length += own.weight[k - own.begin];
        if (axes.radius[k] < axes.radius[narrowest]) narrowest = k;
    }
    const double step = step_radii * sum / length;
    const auto count = std::max(1L, std::lround(length / step));
    std::vector<double> at;
    for (long k = 0; k < count; ++k)
        at.push_back(axes.own_from[branch] + length * (static_cast<double>(k) + 0.5) / static_cast<double>(count));
    if (narrowest > own.begin && narrowest + 1 < own.end) at.push_back(axes.abscissa[narrowest]);
    std::sort(at.begin(), at.end());
    return at;
}

/// Share of a loop's length that is next to sites of other branches.
double share_of_others(const SectionLoop& loop, const std::vector<BranchId>& branches, BranchId own) {
    const std::size_t count = loop.points.size();
    double others = 0, all = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const PlanePoint before = loop.points[(k + count - 1) % count], x = loop.points[k];
        const PlanePoint after = loop.points[(k + 1) % count];
        const double length = std::hypot(x.x - before.x, x.y - before.y) + std::hypot(after.x - x.x, after.y - x.y);
        all += length;
        const BranchId branch = branches[at(loop.nearest[k])];
        if (!branch.is_none() && branch != own) others += length;
    }
    return others / all;
}

class BranchSections {
public:
    BranchSections(const SectionCutter& cutter, const BranchLines& axes, const SurfaceBranches& surface,
                   const SitesAlong& sites)
        : cutter_(cutter), axes_(axes), surface_(surface), sites_(sites) {}

    std::vector<Section> run(std::size_t branch, double step) {
        std::vector<Section> sections;
        for (const double s : stations(axes_, branch, step)) {
            const AxisPlace on = place_on(axes_, BranchId(branch), s);
            Section section;
            section.abscissa = s;
            section.radius = value_at(axes_.radius, on);
            const Vec3 n = normalized(lerp(axes_.tangent[on.point], axes_.tangent[on.point + 1], on.share));
            const Vec3 e = lerp(axes_.frame[on.point], axes_.frame[on.point + 1], on.share);
            const Vec3 e1 = normalized(e - dot(e, n) * n);
            section.plane = {position_at(axes_, on), e1, cross(n, e1), n};
            const SectionLoop loop = loop_at(section);
            section.found = !loop.points.empty();
            if (section.found) section.measures = measure_loop(loop.points);
            section.closed = section.found && loop.wall && is_of(loop, BranchId(branch));
            sections.push_back(section);
        }
        return sections;
    }

private:
    [[nodiscard]] bool is_of(const SectionLoop& loop, BranchId branch) const {
        return surface_.branch.empty() || share_of_others(loop, surface_.branch, branch) <= kOfOthers;
    }

    SectionLoop loop_at(const Section& section) {
        SectionLoop loop = cutter_.cut(section.plane, last_);
        const auto near = std::lower_bound(sites_.begin(), sites_.end(), std::pair{section.abscissa, SiteId(0)});
        const auto from = near - std::min<std::ptrdiff_t>(near - sites_.begin(), kTries / 2);
        for (auto site = from; loop.points.empty() && site != sites_.end() && site - from < std::ptrdiff_t{kTries};
             ++site)
            loop = cutter_.cut(section.plane, site->second);
        if (loop.points.empty()) loop = cutter_.search(section.plane);
        if (!loop.points.empty()) last_ = loop.site;
        return loop;
    }

    const SectionCutter& cutter_;
    const BranchLines& axes_;
    const SurfaceBranches& surface_;
    const SitesAlong& sites_;
    SiteId last_;
};

std::vector<SitesAlong> sites_along(const SurfaceBranches& sites, std::size_t branches) {
    std::vector<SitesAlong> along(branches);
    for (std::size_t i = 0; i < sites.branch.size(); ++i)
        if (!sites.branch[i].is_none()) along[at(sites.branch[i])].emplace_back(sites.longitudinal[i], SiteId(i));
    for (SitesAlong& s : along) std::sort(s.begin(), s.end());
    return along;
}

void append(const Section& s, std::size_t branch, double length, SectionTable& t) {
    const SectionMeasures& m = s.measures;
    const auto value = [&](double v) { return s.found ? v : kNaN; };
    t.branch.emplace_back(branch);
    t.abscissa.push_back(s.abscissa);
    t.relative.push_back(s.abscissa / length);
    t.point.push_back(s.plane.origin);
    t.normal.push_back(s.plane.normal);
    t.area.push_back(value(m.area));
    t.perimeter.push_back(value(m.perimeter));
    t.equivalent_diameter.push_back(value(2 * std::sqrt(m.area / std::numbers::pi)));
    t.hydraulic_diameter.push_back(value(4 * m.area / m.perimeter));
    const bool chords = s.found && m.max_diameter > 0 && std::isfinite(m.min_diameter);
    t.min_diameter.push_back(chords ? m.min_diameter : kNaN);
    t.max_diameter.push_back(chords ? m.max_diameter : kNaN);
    t.min_projection.push_back(value(m.least_width));
    t.inscribed_diameter.push_back(2 * s.radius);
    t.circularity.push_back(value(4 * std::numbers::pi * m.area / (m.perimeter * m.perimeter)));
    t.centroid_offset.push_back(value(std::hypot(m.centroid.x, m.centroid.y)));
    t.closed.push_back(s.closed ? 1 : 0);
}

}  // namespace

SectionTable cut_sections(const Surface& surface, const BranchAxes& branches, const SurfaceBranches& sites,
                          const BranchOptions& options, StageContext& context) {
    const SectionCutter cutter(surface);
    const std::size_t count = branches.graph.branch_count();
    const std::vector<SitesAlong> along = sites_along(sites, count);
    std::vector<std::vector<Section>> found(count);
    context.parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            context.check_cancelled();
            found[b] = BranchSections(cutter, branches.lines, sites, along[b]).run(b, options.section_step);
        }
    });
    SectionTable table;
    std::size_t lost = 0;
    Vec3 where;
    for (std::size_t b = 0; b < count; ++b)
        for (const Section& s : found[b]) {
            append(s, b, branches.lines.length(b), table);
            if (!s.found && lost++ == 0) where = s.plane.origin;
        }
    if (lost > 0)
        context.note("section_not_found",
                     counted(lost, "section") + " of " + std::to_string(table.rows()) +
                         " have no boundary around the axis, the first at " + short_text(where) +
                         ": the axis lies outside of the surface there",
                     static_cast<double>(lost));
    return table;
}

}  // namespace lumenline
