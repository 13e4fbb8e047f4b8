#pragma once

#include <algorithm>
#include <ctime>
#include <string_view>
#include <vector>

namespace lumenline::bench {

/// Processor time of the calling thread [s]: other jobs on the machine do not count.
inline double thread_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The middle value, the mean of the two middle ones; 0 of none.
inline double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// Hash of an array's bytes; T has no padding.
template <class T>
std::size_t digest(const std::vector<T>& values) {
    return std::hash<std::string_view>{}({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

}  // namespace lumenline::bench
