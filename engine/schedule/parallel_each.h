#pragma once

#include <cstddef>
#include <functional>

namespace lumenline {

/// Calls `body(i)` once for each i below `count`, on so many threads (0 = all cores this process may use), in any
/// order. What a call throws reaches the caller, and later calls may be left out.
void parallel_each(int threads, std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace lumenline
