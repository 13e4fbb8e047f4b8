// Entry of libFuzzer; LUMENLINE_READER names the reader that it feeds.

#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/feed.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string fault = lumenline::fuzz::feed(LUMENLINE_READER, {reinterpret_cast<const char*>(data), size});
    if (fault.empty()) return 0;
    std::fprintf(stderr, "%s\n", fault.c_str());
    std::abort();
}
