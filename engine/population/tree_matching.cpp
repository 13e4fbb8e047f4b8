// D(i, j): least cost of matching branch i of the first tree and all behind it to branch j of the second and all behind
// it. F(i, j): the same of what is behind i and j alone, by assignment of children. A branch may stand for a chain of
// branches of the other tree, so D takes the least over the chains that start at i or at j. Children have higher
// numbers than their parents: going down the numbers of both trees, all that an entry needs is there.
//
// Traps: where a leaf is missing its parent and its sibling are one branch; without chains everything behind would be
// matched one level too high. And where three branches leave a node in one tree, in the other two may leave it, one of
// which parts soon: so a child may be left out and its own children take its place.
#include "engine/population/tree_matching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/population/assignment.h"

namespace lumenline {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kNone = Assignment::kNone;
constexpr double kLengthSpread = 0.25;                  // of log length, between subjects
constexpr double kEndSpread = 0.5;                      // the same of a leaf, which ends where its image does
constexpr double kRadiusSpread = 0.2;                   // of log radius
constexpr double kAngleSpread = std::numbers::pi / 12;  // of angles [rad]
constexpr double kNodeSpread = 0.5;                     // of a node's place [radii]
constexpr double kWithout = 4;  // of a branch without counterpart: two of them cost as much as a match four spreads off
constexpr std::size_t kLongestChain = 8;

double angle(Vec3 a, Vec3 b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

/// One branch, or several that follow each other, as one.
struct Chain {
    std::size_t last = 0;            ///< its last branch
    std::size_t count = 1;           ///< branches
    double aside = 0;                ///< branches that leave between them, with all behind
    double length = 0;               ///< [the tree's calibre]
    double weighted = 0, known = 0;  ///< sum of length times log radius, and of these lengths
    Vec3 chord;
    double with_parent = kNaN, with_grandparent = kNaN;  ///< angles [rad]; NaN = no such branch

    [[nodiscard]] double log_radius() const { return weighted / known; }
};

/// A tree with what follows from it.
class Tree {
public:
    explicit Tree(const BranchTree& tree) : tree_(tree), size_(tree.size(), 1), children_(tree.size() + 1) {
        const std::size_t n = tree.size();
        for (std::size_t b = 0; b < n; ++b) children_[tree.parent[b].is_none() ? n : at(tree.parent[b])].push_back(b);
        for (std::size_t b = n; b-- > 0;)
            if (!tree.parent[b].is_none()) size_[at(tree.parent[b])] += size_[b];
        double weight = 0, sum = 0;
        for (std::size_t b = 0; b < n; ++b)
            if (const double r = tree.radius[b], w = r * r * tree.length[b]; w > 0 && std::isfinite(w)) {
                weight += w;
                sum += w * std::log(r);
            }
        calibre_ = weight > 0 ? std::exp(sum / weight) : kNaN;
        for (std::size_t b = 0; b < n; ++b) chains_.push_back(chains_from(b));
    }

    [[nodiscard]] std::size_t count() const { return tree_.size(); }
    [[nodiscard]] double size(std::size_t b) const { return static_cast<double>(size_[b]); }
    /// Of branch `b`; of count(), the branches that start at inlets.
    [[nodiscard]] const std::vector<std::size_t>& children(std::size_t b) const { return children_[b]; }
    [[nodiscard]] bool is_leaf(std::size_t b) const { return children_[b].empty(); }
    /// The same with the children of `child` in its place.
    [[nodiscard]] std::vector<std::size_t> without(std::size_t b, std::size_t child) const {
        std::vector<std::size_t> others = children_[child];
        for (const std::size_t c : children_[b])
            if (c != child) others.push_back(c);
        std::sort(others.begin(), others.end());
        return others;
    }
    /// That start with `b`, the shortest first.
    [[nodiscard]] const std::vector<Chain>& chains(std::size_t b) const { return chains_[b]; }
    /// The branches of a chain that ends with `last`.
    [[nodiscard]] std::vector<std::size_t> branches_of(const Chain& chain) const {
        std::vector<std::size_t> branches(chain.count, chain.last);
        for (std::size_t k = chain.count - 1; k-- > 0;) branches[k] = at(tree_.parent[branches[k + 1]]);
        return branches;
    }

private:
    void extend(Chain& chain, std::size_t b) const {
        const double length = tree_.length[b] / calibre_, radius = tree_.radius[b] / calibre_;
        chain.last = b;
        chain.length += length;
        chain.chord += tree_.chord[b];
        if (!(radius > 0)) return;
        chain.weighted += length * std::log(radius);
        chain.known += length;
    }

    [[nodiscard]] std::vector<Chain> chains_from(std::size_t b) const {
        Chain first;
        extend(first, b);
        std::vector<Chain> chains{first};
        for (std::size_t k = 0; k < chains.size(); ++k) {
            if (chains[k].count == kLongestChain) continue;
            for (const std::size_t child : children_[chains[k].last]) {
                Chain longer = chains[k];
                ++longer.count;
                extend(longer, child);
                longer.aside = static_cast<double>(size_[b] - longer.count - (size_[child] - 1));
                chains.push_back(longer);
            }
        }
        const BranchId parent = tree_.parent[b];
        for (Chain& c : chains) {
            if (parent.is_none()) continue;
            c.with_parent = angle(c.chord, tree_.chord[at(parent)]);
            if (const BranchId above = tree_.parent[at(parent)]; !above.is_none())
                c.with_grandparent = angle(c.chord, tree_.chord[at(above)]);
        }
        return chains;
    }

    const BranchTree& tree_;
    double calibre_ = kNaN;
    std::vector<std::size_t> size_;  // of the subtree
    std::vector<std::vector<std::size_t>> children_;
    std::vector<std::vector<Chain>> chains_;
};

double square(double x) { return x * x; }
/// A difference that is not known costs nothing.
double known(double x) { return std::isnan(x) ? 0 : x; }

class Matcher {
public:
    Matcher(const Tree& first, const Tree& second, bool axes)
        : first_(first),
          second_(second),
          axes_(axes),
          whole_(first.count() * second.count(), kInfinity),
          behind_(whole_.size()) {}

    TreeMatch run() {
        const std::size_t n = first_.count(), m = second_.count();
        for (std::size_t i = n; i-- > 0;)
            for (std::size_t j = m; j-- > 0;) {
                behind_[i * m + j] = children_cost(i, j);
                whole_[i * m + j] = best_pair(i, j).cost;
            }
        match_.partners.resize(n);
        match_.part.resize(n, 0);
        match_.confidence.resize(n, kNaN);
        match_.cost = children_cost(n, m);
        take_children(n, m, kInfinity);
        return std::move(match_);
    }

private:
    /// How a branch of each tree are matched: one of the two chains is a single branch.
    struct Pair {
        const Chain *first = nullptr, *second = nullptr;
        double cost = kInfinity;
        double next = kInfinity;  ///< least cost of another one
    };

    [[nodiscard]] double pair_cost(const Chain& a, const Chain& b) const {
        const bool leaf = first_.is_leaf(a.last) || second_.is_leaf(b.last);
        const double radius = std::exp(std::max(known(a.log_radius()), known(b.log_radius())));
        const double place = square(kNodeSpread * radius / std::min(a.length, b.length));
        const double angles = square(kAngleSpread) + place;
        double sum = known(square(std::log(a.length / b.length)) / (square(leaf ? kEndSpread : kLengthSpread) + place));
        sum += known(square((a.log_radius() - b.log_radius()) / kRadiusSpread));
        sum += known(square(a.with_parent - b.with_parent) / angles);
        sum += known(square(a.with_grandparent - b.with_grandparent) / angles);
        if (axes_) sum += known(square(angle(a.chord, b.chord)) / angles);
        return 0.5 * sum;
    }

    [[nodiscard]] Pair best_pair(std::size_t i, std::size_t j) const {
        Pair best;
        const auto offer = [&](const Chain& a, const Chain& b) {
            const double cost = pair_cost(a, b) + kWithout * (a.aside + b.aside) + behind(a.last, b.last);
            if (cost < best.cost)
                best = {&a, &b, cost, best.cost};
            else
                best.next = std::min(best.next, cost);
        };
        for (const Chain& b : second_.chains(j)) offer(first_.chains(i).front(), b);
        for (const Chain& a : first_.chains(i))
            if (a.count > 1) offer(a, second_.chains(j).front());
        return best;
    }

    [[nodiscard]] double behind(std::size_t i, std::size_t j) const { return behind_[i * second_.count() + j]; }

    /// Two sets of branches to be assigned to each other, at a price for how they came about.
    struct Children {
        std::vector<std::size_t> first, second;
        std::vector<double> pair, without_first, without_second;
        double price = 0;
    };

    [[nodiscard]] Children children_of(std::vector<std::size_t> first, std::vector<std::size_t> second,
                                       double price) const {
        Children c{std::move(first), std::move(second), {}, {}, {}, price};
        for (const std::size_t a : c.first) {
            for (const std::size_t b : c.second) c.pair.push_back(whole_[a * second_.count() + b]);
            c.without_first.push_back(kWithout * first_.size(a));
        }
        for (const std::size_t b : c.second) c.without_second.push_back(kWithout * second_.size(b));
        return c;
    }

    /// What leaves the ends of i and j: as it is, and with one child left out on either side, whose own children take
    /// its place.
    [[nodiscard]] std::vector<Children> children(std::size_t i, std::size_t j) const {
        const std::vector<std::size_t>&first = first_.children(i), &second = second_.children(j);
        std::vector<Children> all{children_of(first, second, 0)};
        for (const std::size_t a : first)
            if (!first_.is_leaf(a)) all.push_back(children_of(first_.without(i, a), second, kWithout));
        for (const std::size_t b : second)
            if (!second_.is_leaf(b)) all.push_back(children_of(first, second_.without(j, b), kWithout));
        return all;
    }

    static Assignment assign_in(const Children& c) {
        Assignment found = assign(c.pair, c.without_first, c.without_second);
        found.cost += c.price;
        return found;
    }

    [[nodiscard]] double children_cost(std::size_t i, std::size_t j) const {
        double least = kInfinity;
        for (const Children& c : children(i, j)) least = std::min(least, assign_in(c).cost);
        return least;
    }

    /// Least cost where `a` does not get `b`.
    static double cost_otherwise(const std::vector<Children>& all, std::size_t a, std::size_t b) {
        double least = kInfinity;
        for (const Children& c : all) {
            const auto k = std::find(c.first.begin(), c.first.end(), a);
            const auto l = std::find(c.second.begin(), c.second.end(), b);
            const double cost = k == c.first.end() || l == c.second.end()
                                    ? assign_in(c).cost
                                    : c.price + assign_otherwise(c.pair, c.without_first, c.without_second,
                                                                 static_cast<std::size_t>(k - c.first.begin()),
                                                                 static_cast<std::size_t>(l - c.second.begin()))
                                                    .cost;
            least = std::min(least, cost);
        }
        return least;
    }

    /// Writes down the match of what is behind i and j, and goes on behind that.
    void take_children(std::size_t i, std::size_t j, double margin) {
        const std::vector<Children> all = children(i, j);
        std::size_t chosen = 0;
        Assignment best = assign_in(all[0]);
        for (std::size_t v = 1; v < all.size(); ++v)
            if (Assignment found = assign_in(all[v]); found.cost < best.cost) {
                best = std::move(found);
                chosen = v;
            }
        for (std::size_t k = 0; k < best.partner.size(); ++k) {
            if (best.partner[k] == kNone) continue;
            const std::size_t a = all[chosen].first[k], b = all[chosen].second[best.partner[k]];
            const Pair pair = best_pair(a, b);
            const double own = std::min({margin, cost_otherwise(all, a, b) - best.cost, pair.next - pair.cost});
            write(pair, own);
            take_children(pair.first->last, pair.second->last, own);
        }
    }

    void write(const Pair& pair, double margin) {
        const std::vector<std::size_t> ours = first_.branches_of(*pair.first);
        const std::vector<std::size_t> theirs = second_.branches_of(*pair.second);
        for (std::size_t k = 0; k < ours.size(); ++k) {
            match_.partners[ours[k]] = theirs;
            match_.part[ours[k]] = ours.size() > 1 ? k + 1 : 0;
            match_.confidence[ours[k]] = -std::expm1(-std::max(margin, 0.0));
        }
    }

    const Tree &first_, &second_;
    bool axes_;
    std::vector<double> whole_, behind_;  // D and F, (i, j)
    TreeMatch match_;
};

}  // namespace

TreeMatch match_trees(const BranchTree& first, const BranchTree& second, bool axes) {
    const Tree a(first), b(second);
    return Matcher(a, b, axes).run();
}

}  // namespace lumenline
