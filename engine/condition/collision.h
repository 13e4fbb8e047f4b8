#pragma once

#include <cstdint>
#include <vector>

#include "engine/condition/opening_plan.h"

namespace lumenline {

/// What an extension must not run into: the wall, discs across all openings, accepted extensions.
class Obstacles {
public:
    /// @param wall  must outlive this object
    Obstacles(const WallMesh& wall, const std::vector<OpeningPlan>& plans);

    /// Adds the surface that closes `plan`.
    void add(const OpeningPlan& plan, const Patch& patch);

    /// Whether something lies within 0.4 edges beside, or one edge before, the extension of `plan` by `length`.
    [[nodiscard]] bool in_the_way(const OpeningPlan& plan, double length) const;

private:
    struct Triangle {
        Vec3 a, b, c;
        std::uint32_t opening;
    };
    const WallMesh* wall_;
    std::vector<Triangle> added_;
};

}  // namespace lumenline
