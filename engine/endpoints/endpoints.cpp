// The modes give a list of ends. Given points and rules take ends from it, and what is left over becomes
// outlets. Openings are anchored only when they are used.
#include "engine/endpoints/endpoints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "engine/core/limits.h"
#include "engine/core/text.h"
#include "engine/endpoints/ends.h"
#include "engine/endpoints/roles.h"
#include "engine/endpoints/tips.h"

namespace lumenline {

namespace {

constexpr double kOpeningReach = 1;  // radii of an opening within which a point means it
constexpr double kTipReach = 3;      // the same for a tip

class Finder {
public:
    Finder(const Surface& surface, const VoronoiComplex& complex, const EndpointOptions& options, StageContext& context)
        : surface_(surface), complex_(complex), options_(options), context_(context) {}

    Endpoints run() {
        refuse_far_points();
        find_ends();
        refuse_missing();
        for (const Vec3& p : options_.inlets) inlets_.push_back(take_wish(p, EndpointRole::kInlet));
        Endpoints outlets;
        for (const Vec3& p : options_.outlets) outlets.push_back(take_wish(p, EndpointRole::kOutlet));
        const bool points_only = options_.mode == EndpointMode::kPoints;
        if (points_only) {  // rules pick among the points
            ends_ = std::move(outlets);
            taken_.assign(ends_.size(), false);
        }
        apply_rules();
        if (points_only || options_.outlets.empty()) outlets = found_outlets(!points_only);
        if (outlets.empty())
            refuse_endpoints(ErrorCode::kNoOutlet, "there is no outlet: the surface has " +
                                                       counted(surface_.openings.size(), "opening") + " and " +
                                                       counted(ends_.size(), "end") +
                                                       " to choose from, all of them inlets; a centerline needs an "
                                                       "inlet and an outlet");
        return joined(std::move(outlets));
    }

private:
    [[nodiscard]] bool has(EndpointMode mode) const { return options_.mode.has(mode); }

    [[nodiscard]] bool wants_tips() const {
        if (has(EndpointMode::kTips)) return true;
        return has(EndpointMode::kAuto) && surface_.openings.empty() &&
               (options_.inlets.empty() || options_.outlets.empty());
    }

    void find_ends() {
        for (std::size_t i = 0; i < surface_.openings.size(); ++i) {
            const EndpointMode wanted = surface_.openings[i].flat_cap ? EndpointMode::kCaps : EndpointMode::kBoundaries;
            if (has(EndpointMode::kAuto) || has(wanted)) ends_.push_back(end_of_opening(surface_, OpeningId(i)));
        }
        if (wants_tips())
            for (const Tip& tip : find_tips(surface_, complex_, options_.tip_length, context_))
                ends_.push_back(endpoint_at_tip(complex_, tip));
        taken_.assign(ends_.size(), false);
    }

    /// Refuses what can have no centerline: too few ends, and points that are asked for but not given.
    void refuse_missing() const {
        const bool by_rule = !options_.inlet_rules.empty();
        if (options_.mode == EndpointMode::kPoints) {
            if ((options_.inlets.empty() && !by_rule) || options_.outlets.empty())
                refuse_endpoints(ErrorCode::kEndpointsMissing,
                                 std::string("endpoints are to be given as points, but ") +
                                     (options_.outlets.empty() ? "no outlet" : "no inlet") +
                                     " point is given: state `inlets` and `outlets` for this model");
            return;
        }
        if (!ends_.empty()) return;
        if (accepts_points() && !options_.inlets.empty() && !options_.outlets.empty()) return;
        std::string missing = "the surface is closed: it has no openings";
        if (has(EndpointMode::kCaps) || has(EndpointMode::kAuto)) missing += ", no flat caps";
        if (wants_tips()) missing += ", no blind end longer than " + short_text(options_.tip_length) + " of its radii";
        refuse_endpoints(ErrorCode::kEndpointsMissing, missing + "; give its inlet and outlets as points");
    }

    /// Refuses points from which distances overflow: no ball would be the nearest.
    void refuse_far_points() const {
        for (const Vec3& p : options_.inlets) refuse_if_far(p, "inlet");
        for (const Vec3& p : options_.outlets) refuse_if_far(p, "outlet");
        for (const InletRule& rule : options_.inlet_rules) refuse_if_far(rule.point, "inlet");
    }

    static void refuse_if_far(Vec3 point, const std::string& role) {
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::fabs(point[axis]) <= kLargestCoordinate))
                refuse_endpoints(ErrorCode::kEndpointOutside, "the " + role + " point " + short_text(point) +
                                                                  " has a coordinate beyond the limit of " +
                                                                  short_text(kLargestCoordinate) +
                                                                  ": give a point inside of the lumen");
    }

    [[nodiscard]] bool accepts_points() const { return has(EndpointMode::kAuto) || has(EndpointMode::kPoints); }

    /// The end that a point means: the one it is nearest to, in shares of the end's reach.
    [[nodiscard]] std::size_t end_at(Vec3 point) const {
        std::size_t best = ends_.size();
        double least = 1;
        for (std::size_t i = 0; i < ends_.size(); ++i) {
            const double reach = (ends_[i].opening.is_none() ? kTipReach : kOpeningReach) * ends_[i].radius;
            const double share = distance(ends_[i].point, point) / reach;
            if (share < least) {
                least = share;
                best = i;
            }
        }
        return best;
    }

    Endpoint take(std::size_t i) {
        if (taken_[i])
            refuse_endpoints(ErrorCode::kEndpointAmbiguous,
                             "two of the given points mean the same " +
                                 std::string(ends_[i].opening.is_none() ? "tip" : "opening") + " at " +
                                 short_text(ends_[i].point));
        taken_[i] = true;
        Endpoint e = ends_[i];
        anchor_end(surface_, complex_, e, context_);
        return e;
    }

    Endpoint take_wish(Vec3 point, EndpointRole role) {
        const std::string name = std::string(role_name(role)) + " point " + short_text(point);
        if (const std::size_t i = end_at(point); i < ends_.size()) return take(i);
        if (!accepts_points())
            refuse_endpoints(ErrorCode::kEndpointOutside,
                             "no opening has its centre within one of its radii of the " + name +
                                 (has(EndpointMode::kTips) ? ", and no tip lies within three of its own" : ""));
        return endpoint_at_point(complex_, point, "the " + name, context_);
    }

    [[nodiscard]] std::vector<std::size_t> free_ends() const {
        std::vector<std::size_t> free;
        for (std::size_t i = 0; i < ends_.size(); ++i)
            if (!taken_[i]) free.push_back(i);
        return free;
    }

    void apply_rules() {
        std::vector<InletRule> rules = options_.inlet_rules;
        const bool automatic = options_.inlets.empty() && rules.size() < 2;
        if (options_.inlets.empty() && rules.empty()) rules.emplace_back();
        for (const InletRule& rule : rules) apply(rule);
        if (automatic && surface_.component_count > 1) give_parts_inlets(rules.front());
    }

    void apply(const InletRule& rule) {
        if (rule.kind == InletRule::Kind::kPoint) {
            if (const std::size_t i = end_at(rule.point); i < ends_.size()) taken_[i] = true;
            inlets_.push_back(
                endpoint_at_point(complex_, rule.point, "the inlet point " + short_text(rule.point), context_));
            return;
        }
        const std::vector<std::size_t> free = free_ends();
        const auto picked = free.empty() ? std::nullopt : pick_inlet(ends_, free, rule, context_);
        if (!picked)
            refuse_endpoints(ErrorCode::kNoInlet,
                             "the inlet is to be '" + rule_text(rule) + "', but " +
                                 (free.empty() ? "all ends have another role"
                                               : "there is no such opening among the ends: the surface has " +
                                                     counted(surface_.openings.size(), "opening")));
        inlets_.push_back(take(*picked));
    }

    /// Gives each part of the lumen that no inlet reaches one of its own, if it has another end for it.
    void give_parts_inlets(InletRule rule) {
        if (rule.kind != InletRule::Kind::kSmallest && rule.kind != InletRule::Kind::kHighest &&
            rule.kind != InletRule::Kind::kLowest)
            rule = InletRule();
        for (;;) {
            for (const std::size_t i : free_ends()) anchor_end_once(i);
            const std::vector<double> cost = costs_from(complex_, inlets_, ends_, context_);
            std::vector<std::size_t> unreached;
            for (const std::size_t i : free_ends())
                if (!(cost[i] < std::numeric_limits<double>::infinity())) unreached.push_back(i);
            if (unreached.empty()) return;
            const std::size_t chosen = *pick_inlet(ends_, unreached, rule, context_);
            const std::vector<double> from = costs_from(complex_, {ends_[chosen]}, ends_, context_);
            const bool alone = std::none_of(unreached.begin(), unreached.end(), [&](std::size_t i) {
                return i != chosen && from[i] < std::numeric_limits<double>::infinity();
            });
            taken_[chosen] = true;
            if (!alone) {
                inlets_.push_back(ends_[chosen]);
                continue;
            }
            context_.warn("endpoint_unconnected", "the " + std::string(kind_name(ends_[chosen].kind)) + " at " +
                                                      short_text(ends_[chosen].point) +
                                                      " is the only end of its part of the lumen, which no inlet "
                                                      "reaches, and is left out: give points if "
                                                      "that part is to have a line");
        }
    }

    void anchor_end_once(std::size_t i) {
        if (ends_[i].seeds.empty()) anchor_end(surface_, complex_, ends_[i], context_);
    }

    /// All ends without a role, in their order along the tree if they were found and not given.
    Endpoints found_outlets(bool sort) {
        Endpoints outlets;
        for (const std::size_t i : free_ends()) {
            anchor_end_once(i);
            outlets.push_back(ends_[i]);
        }
        if (sort && outlets.size() > 1) sort_by_cost(outlets, wall_distances(surface_, inlets_, outlets));
        return outlets;
    }

    Endpoints joined(Endpoints outlets) {
        for (Endpoint& e : inlets_) e.role = EndpointRole::kInlet;
        for (Endpoint& e : outlets) e.role = EndpointRole::kOutlet;
        Endpoints all = std::move(inlets_);
        all.insert(all.end(), std::make_move_iterator(outlets.begin()), std::make_move_iterator(outlets.end()));
        refuse_shared_anchors(all);
        return all;
    }

    static void refuse_shared_anchors(const Endpoints& all) {
        for (std::size_t i = 0; i < all.size(); ++i)
            for (std::size_t j = i + 1; j < all.size(); ++j)
                if (all[i].anchor_vertex == all[j].anchor_vertex)
                    refuse_endpoints(
                        ErrorCode::kEndpointAmbiguous,
                        "the endpoints at " + short_text(all[i].point) + " and " + short_text(all[j].point) +
                            " fall on the same place of the lumen: they are too close, or one of them is misplaced");
    }

    const Surface& surface_;
    const VoronoiComplex& complex_;
    const EndpointOptions& options_;
    StageContext& context_;
    Endpoints ends_;           // openings by descending size, then tips
    std::vector<bool> taken_;  // ends that have a role, or none for good
    Endpoints inlets_;
};

}  // namespace

Endpoints find_endpoints(const Surface& surface, const VoronoiComplex& complex, const EndpointOptions& options,
                         StageContext& context) {
    return Finder(surface, complex, options, context).run();
}

}  // namespace lumenline
