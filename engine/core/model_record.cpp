#include "engine/core/model_record.h"

#include <algorithm>
#include <array>
#include <csignal>


namespace lumenline {

std::string_view status_name(ModelStatus status) {
    static constexpr std::array<std::string_view, 3> kNames{"ok", "warning", "failed"};
    return kNames.at(static_cast<std::size_t>(status));
}

bool is_transient(const Failure& failure) {
    return is_transient(failure.code) || (failure.code == ErrorCode::kCrashed && failure.signal == SIGKILL);
}

namespace {

void summarize_lines(const Centerlines& lines, ModelSummary& summary) {
    summary.centerlines = lines.line_count();
    if (lines.radius.empty()) return;
    const auto [low, high] = std::minmax_element(lines.radius.begin(), lines.radius.end());
    summary.radius_min = *low;
    summary.radius_max = *high;
    double weighted = 0;
    for (std::size_t line = 0; line < lines.line_count(); ++line)
        for (std::size_t k = lines.offsets[line]; k + 1 < lines.offsets[line + 1]; ++k) {
            const double step = lines.abscissa[k + 1] - lines.abscissa[k];
            summary.length += step;
            weighted += step * 0.5 * (lines.radius[k] + lines.radius[k + 1]);
        }
    summary.radius_mean = summary.length > 0 ? weighted / summary.length : *low;
}

// Median of the radius along all lines, each point weighted by its share of the arc length.
double median_radius(const Centerlines& lines) {
    std::vector<std::pair<double, double>> shares;  // radius, length
    double total = 0;
    for (std::size_t line = 0; line < lines.line_count(); ++line)
        for (std::size_t k = lines.offsets[line]; k + 1 < lines.offsets[line + 1]; ++k) {
            const double step = lines.abscissa[k + 1] - lines.abscissa[k];
            shares.emplace_back(0.5 * (lines.radius[k] + lines.radius[k + 1]), step);
            total += step;
        }
    std::sort(shares.begin(), shares.end());
    double passed = 0;
    for (const auto& [radius, step] : shares)
        if ((passed += step) >= 0.5 * total) return radius;
    return 0;
}

}  // namespace

ModelSummary summarize(const ModelRecord& record) {
    ModelSummary summary;
    summary.identity = record.identity;
    summary.status = record.status;
    summary.failure = record.failure;
    summary.warnings =
        static_cast<std::size_t>(std::count_if(record.diagnostics.begin(), record.diagnostics.end(),
                                               [](const Diagnostic& d) { return d.severity != Severity::kNote; }));
    summary.seconds = record.facts.total_seconds;
    if (record.surface) {
        summary.sites = record.surface->site_count();
        summary.triangles = record.surface->triangles.size();
        summary.diagonal = record.surface->diagonal;
        summary.genus = static_cast<std::size_t>(record.surface->genus);
    }
    if (record.complex) {
        summary.voronoi_vertices = record.complex->vertex_count();
        summary.polygons = record.complex->polygon_count();
    }
    if (record.endpoints)
        for (const Endpoint& e : *record.endpoints)
            ++(e.role == EndpointRole::kInlet ? summary.inlets : summary.outlets);
    if (record.centerlines) {
        summarize_lines(*record.centerlines, summary);
        summary.loops = record.centerlines->loops.size();
        const double radius = median_radius(*record.centerlines);
        if (record.surface && radius > 0) summary.edge_over_radius = record.surface->median_edge / radius;
    }
    if (record.character) {
        summary.geodesic_distance = record.character->geodesic_distance_statistics;
        summary.euclidean_distance = record.character->euclidean_distance_statistics;
        summary.normalized_tangency_deviation = record.character->normalized_tangency_deviation_statistics;
        summary.unreached_sites = record.character->unreached;
    }
    return summary;
}

}  // namespace lumenline
