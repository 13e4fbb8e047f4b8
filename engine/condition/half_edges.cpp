#include "engine/condition/half_edges.h"

#include <algorithm>

// Half-edges are distributed by counting into one bucket per lower vertex; a bucket holds some six
// entries, which insertion sort orders by the other vertex faster than any hash table would.

namespace lumenline {
namespace {

struct Entry {
    std::uint32_t far_vertex, half_edge;
};

void sort_bucket(Entry* begin, Entry* end) {
    if (end - begin > 32) {
        std::sort(begin, end, [](const Entry& a, const Entry& b) {
            return a.far_vertex != b.far_vertex ? a.far_vertex < b.far_vertex : a.half_edge < b.half_edge;
        });
        return;
    }
    for (Entry* i = begin; i < end; ++i) {
        const Entry moved = *i;
        Entry* j = i;
        for (; j > begin && moved.far_vertex < (j - 1)->far_vertex; --j) *j = *(j - 1);
        *j = moved;
    }
}

void pair_group(const std::vector<Corners>& triangles, const Entry* begin, const Entry* end, HalfEdgePairs& pairs) {
    const auto count = end - begin;
    if (count == 1) {
        ++pairs.boundary_edges;
        return;
    }
    const std::uint32_t a = begin->half_edge;
    if (count == 2) {
        const std::uint32_t b = (begin + 1)->half_edge;
        pairs.opposite[a] = b;
        pairs.opposite[b] = a;
        if (start_of(triangles, a) != start_of(triangles, b)) return;
        ++pairs.conflicting_edges;
    } else {
        ++pairs.non_manifold_edges;
    }
    if (pairs.first_irregular == kNoHalfEdge) pairs.first_irregular = a;
}

}  // namespace

HalfEdgePairs pair_half_edges(const std::vector<Corners>& triangles, std::size_t vertex_count) {
    std::vector<std::uint32_t> offset(vertex_count + 1, 0);
    for (const Corners& t : triangles) {
        ++offset[std::min(t[0], t[1]) + 1];
        ++offset[std::min(t[1], t[2]) + 1];
        ++offset[std::min(t[2], t[0]) + 1];
    }
    for (std::size_t v = 0; v < vertex_count; ++v) offset[v + 1] += offset[v];
    std::vector<Entry> entries(3 * triangles.size());
    std::vector<std::uint32_t> next(offset.begin(), offset.end() - 1);
    std::uint32_t h = 0;
    for (const Corners& t : triangles) {
        for (std::size_t k = 0; k < 3; ++k, ++h) {
            const std::uint32_t a = t[k], b = t[k == 2 ? 0 : k + 1];
            entries[next[std::min(a, b)]++] = {std::max(a, b), h};
        }
    }
    HalfEdgePairs pairs;
    pairs.opposite.assign(entries.size(), kNoHalfEdge);
    for (std::size_t v = 0; v < vertex_count; ++v) {
        Entry* const begin = entries.data() + offset[v];
        Entry* const end = entries.data() + offset[v + 1];
        sort_bucket(begin, end);
        for (const Entry* group = begin; group < end;) {
            const Entry* group_end = group + 1;
            while (group_end < end && group_end->far_vertex == group->far_vertex) ++group_end;
            pair_group(triangles, group, group_end, pairs);
            group = group_end;
        }
    }
    return pairs;
}

std::uint32_t find_split_vertex(const std::vector<Corners>& triangles, const HalfEdgePairs& pairs,
                                std::size_t vertex_count) {
    std::vector<std::uint32_t> valence(vertex_count, 0), first(vertex_count, kNoHalfEdge);
    for (std::uint32_t h = 0; h < pairs.opposite.size(); ++h) {
        const std::uint32_t v = start_of(triangles, h);
        ++valence[v];
        // The walk below turns through the previous half-edge, so an open fan must start where the
        // half-edge itself is at the boundary.
        if (first[v] == kNoHalfEdge || pairs.opposite[h] == kNoHalfEdge) first[v] = h;
    }
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        if (first[v] == kNoHalfEdge) continue;
        std::uint32_t visited = 0, h = first[v];
        do {
            ++visited;
            h = pairs.opposite[previous_half_edge(h)];
        } while (h != kNoHalfEdge && h != first[v]);
        if (visited != valence[v]) return v;
    }
    return kDropped;
}

}  // namespace lumenline
