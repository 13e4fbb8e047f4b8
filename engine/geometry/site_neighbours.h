#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "engine/core/surface.h"

namespace lumenline {

/// Sites joined to each site by an edge, each once: on a closed oriented surface every edge is run through
/// once each way.
/// @cost O(triangles)
class SiteNeighbours {
public:
    explicit SiteNeighbours(const Surface& surface) : offsets_(surface.site_count() + 1, 0) {
        for (const auto& t : surface.triangles)
            for (const SiteId s : t) ++offsets_[at(s) + 1];
        std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
        neighbours_.resize(offsets_.back());
        std::vector<std::uint32_t> next(offsets_.begin(), offsets_.end() - 1);
        for (const auto& t : surface.triangles)
            for (std::size_t k = 0; k < 3; ++k) neighbours_[next[at(t[k])]++] = t[(k + 1) % 3];
    }

    [[nodiscard]] std::span<const SiteId> of(SiteId site) const {
        return {neighbours_.data() + offsets_[at(site)], neighbours_.data() + offsets_[at(site) + 1]};
    }

private:
    std::vector<std::uint32_t> offsets_;
    std::vector<SiteId> neighbours_;
};

}  // namespace lumenline
