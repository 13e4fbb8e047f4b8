// The built page becomes part of the program through the assembler, which copies the files as they are; a source text
// of their bytes would take the compiler longer than all of this room. CMake names the files and builds this source
// anew when they change.
#include "io/viewer/page.h"

#include <zlib.h>

#include <stdexcept>

// clang-format off
__asm__(
    ".pushsection .rodata\n"
    ".balign 16\n"
    "lumenline_page_begin:\n"
    ".incbin \"" LUMENLINE_PAGE "\"\n"
    "lumenline_page_end:\n"
    ".byte 0\n"
    "lumenline_library_begin:\n"
    ".incbin \"" LUMENLINE_PAGE_LIBRARY "\"\n"
    "lumenline_library_end:\n"
    ".byte 0\n"
    "lumenline_policy_begin:\n"
    ".incbin \"" LUMENLINE_PAGE_POLICY "\"\n"
    "lumenline_policy_end:\n"
    ".byte 0\n"
    ".popsection\n");
// clang-format on

extern "C" {
extern const char lumenline_page_begin[] __attribute__((visibility("hidden")));
extern const char lumenline_page_end[] __attribute__((visibility("hidden")));
extern const char lumenline_library_begin[] __attribute__((visibility("hidden")));
extern const char lumenline_library_end[] __attribute__((visibility("hidden")));
extern const char lumenline_policy_begin[] __attribute__((visibility("hidden")));
extern const char lumenline_policy_end[] __attribute__((visibility("hidden")));
}

namespace lumenline {

namespace {

constexpr int kGzipHeader = 16;  // zlib's way to ask for gzip, added to the size of the window

std::string_view between(const char* begin, const char* end) { return {begin, static_cast<std::size_t>(end - begin)}; }

}  // namespace

std::string_view page_gzip() { return between(lumenline_page_begin, lumenline_page_end); }

std::string_view page_library_gzip() { return between(lumenline_library_begin, lumenline_library_end); }

std::string unpacked(std::string_view packed) {
    z_stream stream{};
    if (inflateInit2(&stream, MAX_WBITS + kGzipHeader) != Z_OK)
        throw std::runtime_error("the built-in page cannot be read: zlib does not start");
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    std::string bytes;
    int status = Z_OK;
    while (status == Z_OK) {
        const std::size_t had = bytes.size();
        bytes.resize(had + (std::size_t{1} << 20));
        stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + had);
        stream.avail_out = static_cast<uInt>(bytes.size() - had);
        status = inflate(&stream, Z_NO_FLUSH);
        bytes.resize(bytes.size() - stream.avail_out);
    }
    inflateEnd(&stream);
    if (status != Z_STREAM_END) throw std::runtime_error("the built-in page is damaged: build the program again");
    return bytes;
}

std::string_view page_policy() {
    std::string_view policy = between(lumenline_policy_begin, lumenline_policy_end);
    while (policy.ends_with('\n')) policy.remove_suffix(1);
    return policy;
}

}  // namespace lumenline
