// Every pair of lines that start (or end) together has one cut, with an interval on both lines. Cuts are united until
// (a) of three lines, two part from the third in one place, and (b) on no line do the intervals of
// two united sets overlap, where a set's interval reaches from its first to its last. What is left are the junctions.
// By (a) two lines pass the same junctions in the same order up to their own, so that their tracts before it can be
// matched one by one.
#include "engine/branches/split.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

namespace lumenline {

namespace {

class Classes {
public:
    explicit Classes(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
    std::size_t of(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    /// The smaller index names the class, whatever the order of calls.
    bool unite(std::size_t i, std::size_t j) {
        i = of(i);
        j = of(j);
        if (i == j) return false;
        parent_[std::max(i, j)] = std::min(i, j);
        return true;
    }

private:
    std::vector<std::size_t> parent_;
};

/// Where two lines part, as an interval on each.
struct Cut {
    std::size_t a, b;
    double a_from, a_to, b_from, b_to;
    bool forward;  ///< they start together; else they end together
};

/// What a line has of a set of cuts.
struct Interval {
    double from, to;
    std::size_t set;
};

constexpr std::size_t kNoCut = std::numeric_limits<std::size_t>::max();

class Splitter {
public:
    Splitter(const Centerlines& lines, std::span<const LineView> views, const StageContext& context)
        : lines_(lines), views_(views), context_(context), count_(views.size()), cut_of_(count_ * count_, kNoCut) {
        split_.contained.resize(count_);
    }

    Split run() {
        find_partings();
        find_contained();
        collect_cuts();
        unite();
        make_nodes();
        make_tracts();
        join_tracts();
        return std::move(split_);
    }

private:
    [[nodiscard]] bool start_together(std::size_t a, std::size_t b) const {
        return lines_.source[a] == lines_.source[b];
    }
    [[nodiscard]] bool end_together(std::size_t a, std::size_t b) const {
        return !start_together(a, b) && !lines_.target[a].is_none() && lines_.target[a] == lines_.target[b];
    }
    [[nodiscard]] bool is_split(std::size_t i) const { return split_.contained[i].in == ContainedLine::kNone; }

    void find_partings() {
        partings_.resize(count_ * count_);
        std::vector<ReversedLine> back(count_);
        for (std::size_t i = 0; i < count_; ++i) {
            context_.check_cancelled();
            for (std::size_t j = 0; j < count_; ++j) {
                if (i == j) continue;
                if (start_together(i, j)) partings_[i * count_ + j] = part(views_[i], views_[j]);
                if (!end_together(i, j)) continue;
                for (const std::size_t k : {i, j})
                    if (back[k].points.empty()) back[k] = reversed(views_[k]);
                partings_[i * count_ + j] = part(back[i].view(), back[j].view());
            }
        }
    }

    /// Short lines first: a line that is left out contains no other one.
    void find_contained() {
        std::vector<std::size_t> order(count_);
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return views_[a].length() < views_[b].length(); });
        for (const std::size_t i : order)
            for (std::size_t n = count_; n-- > 0 && is_split(i);) {
                const std::size_t j = order[n];
                if (j == i || !is_split(j) || partings_[i * count_ + j].leaves) continue;
                if (start_together(i, j))
                    split_.contained[i] = {j, 0};
                else if (end_together(i, j))
                    split_.contained[i] = {j, views_[j].length() - views_[i].length()};
            }
        for (ContainedLine& c : split_.contained)
            while (c.in != ContainedLine::kNone && !is_split(c.in))
                c = {split_.contained[c.in].in, c.shift + split_.contained[c.in].shift};
    }

    void collect_cuts() {
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t j = i + 1; j < count_; ++j) {
                const bool forward = start_together(i, j);
                if (!is_split(i) || !is_split(j) || (!forward && !end_together(i, j))) continue;
                const Parting p = partings_[i * count_ + j], q = partings_[j * count_ + i];
                const double length_i = views_[i].length(), length_j = views_[j].length();
                cut_of_[i * count_ + j] = cut_of_[j * count_ + i] = cuts_.size();
                if (forward)
                    cuts_.push_back({i, j, p.touch, p.exit, q.touch, q.exit, true});
                else
                    cuts_.push_back(
                        {i, j, length_i - p.exit, length_i - p.touch, length_j - q.exit, length_j - q.touch, false});
            }
    }

    [[nodiscard]] std::size_t cut(std::size_t i, std::size_t j) const { return cut_of_[i * count_ + j]; }
    [[nodiscard]] Interval on(std::size_t line, std::size_t c) const {
        return cuts_[c].a == line ? Interval{cuts_[c].a_from, cuts_[c].a_to, c}
                                  : Interval{cuts_[c].b_from, cuts_[c].b_to, c};
    }
    /// How much later a and b part from each other than both do from c; negative if one of them parts from c later.
    [[nodiscard]] double lateness(std::size_t a, std::size_t b, std::size_t c) const {
        const auto later_on = [&](std::size_t line, std::size_t mate) {
            const Interval with_mate = on(line, cut(line, mate)), with_c = on(line, cut(line, c));
            return cuts_[cut(a, b)].forward ? with_mate.from - with_c.from : with_c.to - with_mate.to;
        };
        return std::min(later_on(a, b), later_on(b, a));
    }

    /// Of three lines, two part from the third in one place.
    void unite_three(std::size_t i, std::size_t j, std::size_t k, Classes& sets) const {
        const std::size_t ij = cut(i, j), ik = cut(i, k), jk = cut(j, k);
        if (ij == kNoCut || ik == kNoCut || jk == kNoCut) return;
        if (cuts_[ij].forward != cuts_[ik].forward || cuts_[ij].forward != cuts_[jk].forward) return;
        std::array<std::pair<double, std::size_t>, 3> late{
            {{lateness(i, j, k), ij}, {lateness(i, k, j), ik}, {lateness(j, k, i), jk}}};
        std::sort(late.begin(), late.end());
        sets.unite(late[0].second, late[1].second);
        if (late[1].first == late[2].first) sets.unite(late[1].second, late[2].second);
    }

    void unite() {
        Classes sets(cuts_.size());
        for (std::size_t i = 0; i < count_; ++i) {
            context_.check_cancelled();
            for (std::size_t j = 0; j < count_; ++j) {
                for (std::size_t k = j + 1; j > i && k < count_; ++k) unite_three(i, j, k, sets);
                if (cut(i, j) != kNoCut) unite_across(i, j, sets);
            }
        }
        do {
            while (unite_overlapping(sets)) {
            }
        } while (unite_unlike(sets));
        set_of_.resize(cuts_.size());
        for (std::size_t c = 0; c < cuts_.size(); ++c) set_of_[c] = sets.of(c);
    }

    /// Lines i and j of one source, joined by lines of another source to the same targets before they part.
    void unite_across(std::size_t i, std::size_t j, Classes& sets) const {
        if (!cuts_[cut(i, j)].forward) return;
        for (std::size_t k = 0; k < count_; ++k) {
            if (cut(i, k) == kNoCut || cuts_[cut(i, k)].forward) continue;
            if (!(on(i, cut(i, k)).to < on(i, cut(i, j)).from)) continue;
            for (std::size_t m = 0; m < count_; ++m)
                if (start_together(k, m) && cut(j, m) != kNoCut && !cuts_[cut(j, m)].forward)
                    sets.unite(cut(i, k), cut(j, m));
        }
    }

    /// Intervals of the sets on a line, ascending.
    std::vector<Interval> intervals(std::size_t line, Classes& sets) const {
        std::map<std::size_t, Interval> hulls;
        for (std::size_t j = 0; j < count_; ++j) {
            if (j == line || cut(line, j) == kNoCut) continue;
            Interval own = on(line, cut(line, j));
            own.set = sets.of(own.set);
            const auto [hull, is_new] = hulls.try_emplace(own.set, own);
            hull->second.from = std::min(hull->second.from, own.from);
            hull->second.to = std::max(hull->second.to, own.to);
        }
        std::vector<Interval> sorted;
        for (const auto& [set, hull] : hulls) sorted.push_back(hull);
        std::sort(sorted.begin(), sorted.end(), [](const Interval& a, const Interval& b) {
            return a.from < b.from || (a.from == b.from && a.set < b.set);
        });
        return sorted;
    }

    bool unite_overlapping(Classes& sets) const {
        bool changed = false;
        for (std::size_t i = 0; i < count_; ++i) {
            double reach = -std::numeric_limits<double>::infinity();
            std::size_t before = 0;
            for (const Interval& hull : intervals(i, sets)) {
                if (hull.from <= reach) changed = sets.unite(before, hull.set) || changed;
                before = hull.set;
                reach = std::max(reach, hull.to);
            }
        }
        return changed;
    }

    /// Two lines pass the same sets, in the same order, up to where they part. Lines whose abscissas differ much may
    /// have been compared wrongly above: then the first sets that differ are one.
    bool unite_unlike(Classes& sets) const {
        std::vector<std::vector<Interval>> passed;
        for (std::size_t i = 0; i < count_; ++i) passed.push_back(intervals(i, sets));
        bool changed = false;
        for (std::size_t c = 0; c < cuts_.size(); ++c) {
            const auto &a = passed[cuts_[c].a], &b = passed[cuts_[c].b];
            for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n) {
                const std::size_t p = a[cuts_[c].forward ? n : a.size() - 1 - n].set;
                const std::size_t q = b[cuts_[c].forward ? n : b.size() - 1 - n].set;
                changed = sets.unite(p, q) || changed;
                if (p == sets.of(c) || q == sets.of(c)) break;
            }
        }
        return changed;
    }

    std::size_t end_node(std::map<std::uint64_t, std::size_t>& known, EndpointId endpoint, LoopId loop) {
        const std::uint64_t key = endpoint.is_none() ? (std::uint64_t{1} << 32) + at(loop) : at(endpoint);
        const auto [entry, is_new] = known.try_emplace(key, split_.nodes.size());
        if (is_new) split_.nodes.push_back({endpoint, loop, {}});
        return entry->second;
    }

    void make_nodes() {
        std::map<std::uint64_t, std::size_t> ends;
        std::map<std::size_t, std::size_t> junctions;
        passed_.resize(count_);
        Classes sets(cuts_.size());
        for (std::size_t c = 0; c < cuts_.size(); ++c) sets.unite(c, set_of_[c]);
        for (std::size_t i = 0; i < count_; ++i) {
            if (!is_split(i)) continue;
            const auto pass = [&](std::size_t node, double from, double to) {
                split_.nodes[node].parts.push_back({i, from, to});
                passed_[i].push_back(node);
            };
            pass(end_node(ends, lines_.source[i], {}), 0, 0);
            for (const Interval& hull : intervals(i, sets)) {
                const auto [entry, is_new] = junctions.try_emplace(hull.set, split_.nodes.size());
                if (is_new) split_.nodes.emplace_back();
                pass(entry->second, hull.from, hull.to);
            }
            const double length = views_[i].length();
            pass(end_node(ends, lines_.target[i], lines_.loop[i]), length, length);
        }
    }

    [[nodiscard]] const NodePart& part_of(std::size_t node, std::size_t line) const {
        return *std::find_if(split_.nodes[node].parts.begin(), split_.nodes[node].parts.end(),
                             [line](const NodePart& p) { return p.line == line; });
    }

    void make_tracts() {
        for (std::size_t i = 0; i < count_; ++i) {
            split_.first_tract.push_back(split_.tracts.size());
            for (std::size_t n = 0; n + 1 < passed_[i].size(); ++n) {
                const std::size_t first = passed_[i][n], last = passed_[i][n + 1];
                // A line that starts and ends in one node cannot be: its two parts there would have been united.
                split_.tracts.push_back({i, first, last, part_of(first, i).to, part_of(last, i).from, 0});
            }
        }
        split_.first_tract.push_back(split_.tracts.size());
    }

    void join_tracts() {
        Classes edges(split_.tracts.size());
        for (const Cut& c : cuts_) {
            const std::size_t a = split_.first_tract[c.a], b = split_.first_tract[c.b];
            const std::size_t a_count = split_.first_tract[c.a + 1] - a, b_count = split_.first_tract[c.b + 1] - b;
            for (std::size_t n = 0; n < std::min(a_count, b_count); ++n) {
                const std::size_t t = c.forward ? a + n : a + a_count - 1 - n;
                const std::size_t u = c.forward ? b + n : b + b_count - 1 - n;
                const Tract &p = split_.tracts[t], &q = split_.tracts[u];
                if (p.first != q.first || p.last != q.last || !together(c, p)) break;
                edges.unite(t, u);
            }
        }
        std::map<std::size_t, std::size_t> numbers;
        for (std::size_t t = 0; t < split_.tracts.size(); ++t)
            split_.tracts[t].edge = numbers.try_emplace(edges.of(t), numbers.size()).first->second;
        split_.edge_count = numbers.size();
    }

    /// Is the tract on the side of the cut where its two lines run together?
    [[nodiscard]] bool together(const Cut& c, const Tract& t) const {
        const Interval own = on(t.line, static_cast<std::size_t>(&c - cuts_.data()));
        return c.forward ? t.own_to <= own.from : t.own_from >= own.to;
    }

    const Centerlines& lines_;
    std::span<const LineView> views_;
    const StageContext& context_;
    std::size_t count_;
    std::vector<Parting> partings_;    // (L x L)
    std::vector<std::size_t> cut_of_;  // (L x L)
    std::vector<Cut> cuts_;
    std::vector<std::size_t> set_of_;               // per cut
    std::vector<std::vector<std::size_t>> passed_;  // per line: nodes in order
    Split split_;
};

}  // namespace

Split split_lines(const Centerlines& lines, std::span<const LineView> views, const StageContext& context) {
    return Splitter(lines, views, context).run();
}

}  // namespace lumenline
