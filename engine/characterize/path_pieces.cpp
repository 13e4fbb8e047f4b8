// Two points of a path that follow each other share a polygon, which then holds the segment between them, unless the
// trace dropped points closer than 1e-2 R. Then the polygon of the one that comes nearest to the other holds the rest
// of the segment, from the place of that approach: what remains is shorter than what was dropped. The polygons around
// each point that hold neither segment are touched in that point.
#include "engine/characterize/path_pieces.h"

#include <algorithm>

#include "engine/geometry/nearest_on_polygon.h"

namespace lumenline {

namespace {

constexpr double kSameLine = 1e-2;  // of the ball radius: the least step of a path

using Polygons = std::vector<PolygonId>;

class Gatherer {
public:
    Gatherer(const Surface& surface, const VoronoiComplex& complex, const Endpoints& endpoints,
             const Centerlines& lines)
        : surface_(surface), complex_(complex), endpoints_(endpoints), lines_(lines) {}

    std::vector<std::pair<PolygonId, PathPiece>> run() {
        for (std::size_t line = 0; line < lines_.line_count(); ++line) add_line(line);
        std::stable_sort(pieces_.begin(), pieces_.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        return std::move(pieces_);
    }

private:
    void add_line(std::size_t line) {
        line_ = LineId(line);
        const std::size_t begin = lines_.path.offsets[line], end = lines_.path.offsets[line + 1];
        Polygons before, here = polygons_of(begin, lines_.source[line]), shared_before;
        for (std::size_t i = begin; i < end; ++i) {
            Polygons shared, after;
            if (i + 1 < end) {
                after = polygons_of(i + 1, lines_.target[line]);
                std::set_intersection(here.begin(), here.end(), after.begin(), after.end(), std::back_inserter(shared));
                for (const PolygonId p : shared) add(p, i, point(i), point(i + 1), 0, 1);
                if (shared.empty()) bridge(i, here, after);
            }
            for (const PolygonId p : here)
                if (!std::binary_search(shared.begin(), shared.end(), p) &&
                    !std::binary_search(shared_before.begin(), shared_before.end(), p))
                    touch(p, i, end);
            shared_before = std::move(shared);
            here = std::move(after);
        }
    }

    /// Polygons that hold the path's point i, ascending.
    [[nodiscard]] Polygons polygons_of(std::size_t i, EndpointId end) const {
        const ComplexPoint& place = lines_.path.places[i];
        if (!place.a.is_none()) return polygons_of(place);
        Polygons found = endpoints_[at(end)].anchor_polygons;
        std::sort(found.begin(), found.end());
        return found;
    }

    [[nodiscard]] Polygons polygons_of(const ComplexPoint& place) const {
        const auto around = complex_.polygons_of(place.a);
        if (place.is_vertex()) return {around.begin(), around.end()};
        const auto others = complex_.polygons_of(place.b);
        Polygons found;
        std::set_intersection(around.begin(), around.end(), others.begin(), others.end(), std::back_inserter(found));
        return found;
    }

    /// The segment after point i where its ends share no polygon.
    void bridge(std::size_t i, const Polygons& here, const Polygons& after) {
        const Vec3 a = point(i), b = point(i + 1);
        const auto [p, near_b] = nearest(here, b);
        const auto [q, near_a] = nearest(after, a);
        const bool from_a = distance(near_b.point, b) < distance(near_a.point, a);
        const NearestOnPolygon& end = from_a ? near_b : near_a;
        const double share = nearest_on_segment(a, b, end.point);
        if (from_a)
            add(p, i, a, end.point, 0, share);
        else
            add(q, i, end.point, b, share, 1);
        if (end.is_inside()) return;
        for (const PolygonId r : polygons_of(end.place))
            if (r != (from_a ? p : q)) add(r, i, end.point, end.point, share, share);
    }

    [[nodiscard]] std::pair<PolygonId, NearestOnPolygon> nearest(const Polygons& polygons, Vec3 x) const {
        std::pair<PolygonId, NearestOnPolygon> best;
        for (const PolygonId p : polygons) {
            const NearestOnPolygon there = nearest_on_polygon(surface_, complex_, p, x);
            if (best.first.is_none() || distance(there.point, x) < distance(best.second.point, x)) best = {p, there};
        }
        return best;
    }

    void touch(PolygonId p, std::size_t i, std::size_t end) {
        if (i + 1 < end)
            add(p, i, point(i), point(i), 0, 0);
        else
            add(p, i - 1, point(i), point(i), 1, 1);
    }

    void add(PolygonId p, std::size_t i, Vec3 from, Vec3 to, double share_from, double share_to) {
        pieces_.push_back({p, {from, to, static_cast<std::uint32_t>(i), share_from, share_to, line_}});
    }

    [[nodiscard]] Vec3 point(std::size_t i) const { return lines_.path.points[i]; }

    const Surface& surface_;
    const VoronoiComplex& complex_;
    const Endpoints& endpoints_;
    const Centerlines& lines_;
    LineId line_;
    std::vector<std::pair<PolygonId, PathPiece>> pieces_;
};

}  // namespace

PathPieces::PathPieces(const Surface& surface, const VoronoiComplex& complex, const Endpoints& endpoints,
                       const Centerlines& lines)
    : first_(complex.polygon_count(), 0), last_(complex.polygon_count(), 0) {
    const auto gathered = Gatherer(surface, complex, endpoints, lines).run();
    pieces_.reserve(gathered.size());
    for (const auto& [p, piece] : gathered) {
        if (!crosses(p)) {
            first_[at(p)] = static_cast<std::uint32_t>(pieces_.size());
            polygons_.push_back(p);
        }
        pieces_.push_back(piece);
        last_[at(p)] = static_cast<std::uint32_t>(pieces_.size());
    }
}

PathFoot PathPieces::nearest(PolygonId p, Vec3 x, double radius) const {
    PathFoot best;
    for (const PathPiece& piece : in(p)) {
        const double t = nearest_on_segment(piece.from, piece.to, x);
        const Vec3 foot = lerp(piece.from, piece.to, t);
        const double away = distance(foot, x);
        // Pieces stand in the order of their lines: a later line must be nearer by more than lines run together.
        const double margin = best.line.is_none() || piece.line == best.line ? 0.0 : kSameLine * radius;
        if (!(away + margin < best.distance)) continue;
        best = {foot, away, piece.point, piece.share_from + t * (piece.share_to - piece.share_from), piece.line};
    }
    return best;
}

}  // namespace lumenline
