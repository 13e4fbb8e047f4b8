// Every vertex gets the neighbour, along the chords of its polygons, through which it is reached earliest: a tree of
// ways from the sources, along which classes add up. An edge between two vertices closes a cycle over the tree whose
// class is that of the two ways and its own. Edges of classes other than zero are where fronts met: where T has a
// kink across a handle. The first such edge of each handle, by the time at which the fronts meet on it, is where the
// handle's shortest cycle closes; taking them in this order, and only those that are independent of the ones before,
// gives the shortest basis of all cycles (Erickson and Whittlesey 2005). Where its way leaves the lumen, as polygons do
// where the sampling is coarse, the next edges of the same class are tried.
//
// Where there are several sources, a class has a bit for each of them beside those of the cycles, which stands in the
// ways from it: a way from one source to another is then closed, as if the sources were one point, and independent of
// what goes around handles. A vertex belongs to the source of its way through the tree; where fronts of two sources
// meet, that may be the one that comes a little later.
//
// Chords make crooked lines. The sides are traced back as any other line; near where fronts meet, such a trace may
// choose the other side, which its class tells: it is then begun farther down the tree.
#include "engine/trace/loops.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "engine/core/text.h"
#include "engine/geometry/segment_cost.h"
#include "engine/trace/cycle_classes.h"

namespace lumenline {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBallStep = 0.25;  // between balls along a side, in their radii
constexpr int kMostTries = 64;      // of meetings of one class whose ways leave the lumen

struct Ball {
    Vec3 centre;
    double radius = 0;  ///< [length]
};

/// Balls along a path, from its start to the vertex after its last inner point.
std::vector<Ball> balls_along(const VoronoiComplex& complex, const ComplexPath& path) {
    std::vector<Ball> balls{{path.start, path.start_radius}};
    for (const ComplexPoint& p : path.inner) {
        const Ball next{position(complex, p), ball_radius(complex, p)};
        if (distance(next.centre, balls.back().centre) > kBallStep * std::min(next.radius, balls.back().radius))
            balls.push_back(next);
    }
    balls.push_back({path.end, path.end_radius});
    return balls;
}

/// Whether both rows of balls can be walked in step, without turning back, with overlapping balls all the way.
bool in_step(std::span<const Ball> a, std::span<const Ball> b) {
    std::vector<char> reached(b.size(), 0);  // with the ball of `a` before, then with the one at hand
    for (std::size_t i = 0; i < a.size(); ++i) {
        bool before = false;  // with the ball of `a` before, and the one of `b` before
        for (std::size_t k = 0; k < b.size(); ++k) {
            const bool above = reached[k] != 0;
            const bool from = (i == 0 && k == 0) || above || before || (k > 0 && reached[k - 1] != 0);
            const bool overlap =
                squared_norm(a[i].centre - b[k].centre) < a[i].radius * a[i].radius + b[k].radius * b[k].radius;
            before = above;
            reached[k] = from && overlap ? 1 : 0;
        }
    }
    return reached.back() != 0;
}

class LoopFinder {
public:
    LoopFinder(const VoronoiComplex& complex, const Endpoints& endpoints,
               std::span<const std::shared_ptr<const ArrivalField>> fields, Fronts fronts,
               const std::function<bool(const ComplexPath&)>& inside, StageContext& context)
        : complex_(complex),
          endpoints_(endpoints),
          fields_(fields),
          join_sources_(fronts == Fronts::kOfAll && fields.size() > 1),
          inside_(inside),
          context_(context),
          classes_(complex),
          field_(complex.vertex_count(), kNoField),
          parent_(complex.vertex_count()),
          way_(complex.vertex_count()) {}

    LoopSearch run() {
        if (classes_.count() == 0 && !join_sources_) return {};
        grow_tree();
        std::map<CycleClass, int> tried;
        for (Meeting& m : meetings()) {
            context_.check_cancelled();
            settled_.reduce(m.cycle);
            if (is_zero(m.cycle) || ++tried[m.cycle] > kMostTries) continue;
            if (settles(m)) settled_.insert(std::move(m.cycle));
        }
        const std::size_t between = count_between_sources();
        return {std::move(loops_), between};
    }

private:
    static constexpr std::uint32_t kNoField = std::numeric_limits<std::uint32_t>::max();
    static constexpr std::size_t kWordBits = 64;

    struct Meeting {
        double time = 0;
        CycleClasses::Edge edge = 0;
        CycleClass cycle;
    };

    [[nodiscard]] double time(VoronoiVertexId v) const { return fields_[field_[at(v)]]->time[at(v)]; }
    [[nodiscard]] double time(CycleClasses::Edge e) const {
        const auto [a, b] = classes_.ends(e);
        return 0.5 * (time(a) + time(b) + cost(a, b));
    }
    [[nodiscard]] double cost(VoronoiVertexId a, VoronoiVertexId b) const {
        return segment_cost(distance(complex_.vertices[at(a)], complex_.vertices[at(b)]),
                            complex_.ball_radius[at(a)] + complex_.ball_radius[at(b)]);
    }
    [[nodiscard]] EndpointId source_id(VoronoiVertexId v) const { return fields_[field_[at(v)]]->source; }
    [[nodiscard]] const Endpoint& source_of(VoronoiVertexId v) const { return endpoints_[at(source_id(v))]; }

    /// Class of the way that has not left its source yet.
    [[nodiscard]] CycleClass way_at_source(std::uint32_t field) const {
        CycleClass way = classes_.zero();
        if (!join_sources_) return way;
        way.resize(way.size() + fields_.size() / kWordBits + 1, 0);
        way[classes_.zero().size() + field / kWordBits] |= std::uint64_t{1} << (field % kWordBits);
        return way;
    }

    void grow_tree() {
        std::vector<std::uint32_t> order;
        for (std::uint32_t f = 0; f < fields_.size(); ++f)
            for (std::uint32_t v = 0; v < field_.size(); ++v) {
                if (!(fields_[f]->time[v] < kInfinity)) continue;
                if (field_[v] == kNoField) order.push_back(v);
                if (field_[v] == kNoField || (join_sources_ && fields_[f]->time[v] < time(VoronoiVertexId(v))))
                    field_[v] = f;
            }
        const auto earlier = [this](std::uint32_t a, std::uint32_t b) {
            const double ta = time(VoronoiVertexId(a)), tb = time(VoronoiVertexId(b));
            return ta != tb ? ta < tb : a < b;
        };
        std::sort(order.begin(), order.end(), earlier);
        std::vector<char> done(field_.size(), 0);
        for (const std::uint32_t v : order) {
            join_tree(VoronoiVertexId(v), done);
            done[v] = 1;
        }
    }

    /// Finds the vertex before v on its way from the source. Vertices that share a polygon with the source's
    /// anchor come from the anchor, whose place in the tree its nearest vertex stands for.
    void join_tree(VoronoiVertexId v, const std::vector<char>& done) {
        const Endpoint& source = source_of(v);
        way_[at(v)] = way_at_source(field_[at(v)]);
        if (v == source.anchor_vertex) return;
        PolygonId through;
        double best = kInfinity;
        bool from_anchor = false;
        for (const PolygonId p : complex_.polygons_of(v)) {
            const auto polygon = complex_.polygon(p);
            const bool holds_anchor = std::find(source.anchor_polygons.begin(), source.anchor_polygons.end(), p) !=
                                      source.anchor_polygons.end();
            if (holds_anchor && std::find(polygon.begin(), polygon.end(), source.anchor_vertex) != polygon.end()) {
                through = p;
                from_anchor = true;
                break;
            }
            for (const VoronoiVertexId w : polygon) {
                if (done[at(w)] == 0 || w == v) continue;
                const double reached = time(w) + cost(w, v);
                if (!(reached < best)) continue;
                best = reached;
                through = p;
                parent_[at(v)] = w;
            }
        }
        if (from_anchor) parent_[at(v)] = source.anchor_vertex;
        if (through.is_none()) return;
        if (!from_anchor) {
            way_[at(v)] = way_[at(parent_[at(v)])];
            field_[at(v)] = field_[at(parent_[at(v)])];
        }
        classes_.add_way(through, parent_[at(v)], v, way_[at(v)]);
    }

    /// Edges where different ways meet, in order of time.
    std::vector<Meeting> meetings() const {
        std::vector<Meeting> found;
        for (CycleClasses::Edge e = 0; e < classes_.edge_count(); ++e) {
            const auto [a, b] = classes_.ends(e);
            if (field_[at(a)] == kNoField || field_[at(b)] == kNoField) continue;
            CycleClass cycle = way_[at(a)];
            add(cycle, way_[at(b)]);
            add(cycle, classes_.of_edge(e));
            if (!is_zero(cycle)) found.push_back({time(e), e, std::move(cycle)});
        }
        std::sort(found.begin(), found.end(), [](const Meeting& a, const Meeting& b) {
            return a.time != b.time ? a.time < b.time : a.edge < b.edge;
        });
        return found;
    }

    /// Tells whether the meeting's cycle is a loop, and adds it if so; false where this meeting's way leaves the lumen.
    bool settles(const Meeting& m) {
        auto [near, far] = classes_.ends(m.edge);
        if (time(far) < time(near)) std::swap(near, far);
        ComplexPath there = trace_side(near);
        const ComplexPath back = trace_side(far);
        there.inner.push_back({near, near, 0});
        there.end = complex_.vertices[at(far)];
        there.end_radius = complex_.ball_radius[at(far)];
        if (in_step(balls_along(complex_, there), balls_along(complex_, back))) {
            side_by_side_.push_back({source_id(near), source_id(far)});
            return true;
        }
        LoopPath loop{{source_id(near), source_id(far)}, far, m.time, std::move(there)};
        loop.path.inner.push_back({far, far, 0});
        loop.path.inner.insert(loop.path.inner.end(), back.inner.rbegin(), back.inner.rend());
        loop.path.end = back.start;
        loop.path.end_radius = back.start_radius;
        if (!inside_(loop.path)) return false;
        if (!repeats_another(loop)) loops_.push_back(std::move(loop));
        return true;
    }

    /// How many of the loops join sources to others that no loop before them joined; those whose balls overlap are one.
    [[nodiscard]] std::size_t count_between_sources() const {
        std::vector<EndpointId> group(endpoints_.size());
        for (std::size_t e = 0; e < group.size(); ++e) group[e] = EndpointId(e);
        const auto join = [&](const std::array<EndpointId, 2>& sources) {
            const EndpointId a = group[at(sources[0])], b = group[at(sources[1])];
            std::replace(group.begin(), group.end(), b, a);
            return a != b;
        };
        for (const auto& sources : side_by_side_) join(sources);
        std::size_t between = 0;
        for (const LoopPath& loop : loops_) between += join(loop.sources) ? 1 : 0;
        return between;
    }

    /// Whether the loop runs along another one, the other side of a hole in a sheet.
    [[nodiscard]] bool repeats_another(const LoopPath& loop) const {
        std::vector<Ball> balls = balls_along(complex_, loop.path);
        for (const bool turned : {false, true}) {
            if (turned) std::reverse(balls.begin(), balls.end());
            for (const LoopPath& other : loops_)
                if (in_step(balls, balls_along(complex_, other.path))) return true;
        }
        return false;
    }

    /// The path from the source to v that goes v's way through the tree; `v` itself is its end.
    [[nodiscard]] ComplexPath trace_side(VoronoiVertexId v) const {
        std::vector<VoronoiVertexId> chain{v};
        const auto descend = [&] {
            if (parent_[at(chain.back())].is_none()) return false;
            chain.push_back(parent_[at(chain.back())]);
            return true;
        };
        std::optional<ComplexPath> path;
        for (std::size_t steps = 1;; steps *= 2) {
            path = traced_along_tree(chain.back());
            if (path) break;
            const std::size_t before = chain.size();
            while (chain.size() < before + steps && descend()) {
            }
            if (chain.size() == before) {  // the tree's root: the chain itself is the path
                path.emplace();
                path->start = source_of(v).anchor;
                path->start_radius = source_of(v).anchor_radius;
                break;
            }
        }
        for (std::size_t i = chain.size(); i-- > 1;) path->inner.push_back({chain[i], chain[i], 0});
        path->end = complex_.vertices[at(v)];
        path->end_radius = complex_.ball_radius[at(v)];
        return *std::move(path);
    }

    /// The path of steepest descent from v; none where it goes another way than the tree.
    [[nodiscard]] std::optional<ComplexPath> traced_along_tree(VoronoiVertexId v) const {
        Endpoint target;
        target.anchor = complex_.vertices[at(v)];
        target.anchor_radius = complex_.ball_radius[at(v)];
        const auto polygons = complex_.polygons_of(v);
        target.anchor_polygons.assign(polygons.begin(), polygons.end());
        std::optional<ComplexPath> path = trace_back(complex_, fields_[field_[at(v)]]->time, source_of(v), target);
        if (!path) return std::nullopt;
        if (!path->inner.empty() && path->inner.back().a == v && path->inner.back().is_vertex()) path->inner.pop_back();
        VoronoiVertexId last = path->inner.empty() ? v : path->inner.front().a;
        CycleClass sum = way_[at(last)];  // it shares a polygon with the source
        for (std::size_t i = 1; i <= path->inner.size(); ++i) {
            const ComplexPoint next = i < path->inner.size() ? path->inner[i] : ComplexPoint{v, v, 0};
            if (!add_step(path->inner[i - 1], next, sum)) return std::nullopt;
        }
        return sum == way_[at(v)] ? path : std::nullopt;
    }

    /// Adds the way from the first vertex of one place to that of the next, in a polygon that holds both places.
    bool add_step(const ComplexPoint& from, const ComplexPoint& to, CycleClass& sum) const {
        for (const PolygonId p : complex_.polygons_of(from.a)) {
            const auto polygon = complex_.polygon(p);
            const auto holds = [&](VoronoiVertexId v) {
                return std::find(polygon.begin(), polygon.end(), v) != polygon.end();
            };
            if (!holds(from.b) || !holds(to.a) || !holds(to.b)) continue;
            classes_.add_way(p, from.a, to.a, sum);
            return true;
        }
        return false;
    }

    const VoronoiComplex& complex_;
    const Endpoints& endpoints_;
    std::span<const std::shared_ptr<const ArrivalField>> fields_;
    const bool join_sources_;
    const std::function<bool(const ComplexPath&)>& inside_;
    StageContext& context_;
    CycleClasses classes_;
    std::vector<std::uint32_t> field_;     // per vertex: the one it belongs to
    std::vector<VoronoiVertexId> parent_;  // per vertex: the one before on its way
    std::vector<CycleClass> way_;          // per vertex: class of its way
    ClassSpan settled_;                    // of the cycles that are loops, or known to be none
    std::vector<LoopPath> loops_;
    std::vector<std::array<EndpointId, 2>> side_by_side_;  // sources between which balls overlap all the way
};

std::string places(const std::vector<LumenLoop>& loops) {
    std::string text;
    for (std::size_t i = 0; i < loops.size(); ++i)
        text += (i == 0 ? "" : i + 1 == loops.size() ? " and " : ", ") + short_text(loops[i].point);
    return text;
}

}  // namespace

LoopSearch find_loops(const VoronoiComplex& complex, const Endpoints& endpoints,
                      std::span<const std::shared_ptr<const ArrivalField>> fields, Fronts fronts,
                      const std::function<bool(const ComplexPath&)>& inside, StageContext& context) {
    return LoopFinder(complex, endpoints, fields, fronts, inside, context).run();
}

LumenLoop loop_of(const VoronoiComplex& complex, const LoopPath& path) {
    return {path.sources[0], complex.vertices[at(path.meeting)], complex.ball_radius[at(path.meeting)], path.time};
}

void report_loops(const Surface& surface, const std::vector<LumenLoop>& loops, std::size_t between_sources,
                  bool covered, StageContext& context) {
    const auto count = static_cast<double>(loops.size());
    const double expected = surface.genus + static_cast<double>(between_sources);
    std::string genus = "genus " + std::to_string(surface.genus);
    if (between_sources > 0) genus += ", and " + std::to_string(between_sources) + " from inlet to inlet";
    const std::string found =
        "the lumen has " + counted(loops.size(), "loop") + " (" + genus + "); fronts meet at " + places(loops);
    if (covered && !loops.empty())
        context.note("loops_covered", found + ": two lines each meet there", count, expected);
    else if (!loops.empty())
        context.warn("loop_not_covered",
                     found +
                         ": lines to the outlets alone leave a side of a loop without a line; "
                         "`topology: network` covers both",
                     count, expected);
    if (count != expected)
        context.warn("loops_unlike_genus",
                     counted(loops.size(), "loop") + " found in a lumen of " + genus +
                         ": handles smaller than the sampling tells apart, or in parts that no front reached; look for "
                         "small handles of the segmentation and vessels that touch",
                     count, expected);
}

}  // namespace lumenline
