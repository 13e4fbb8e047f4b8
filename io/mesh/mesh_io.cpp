// Finds the format of a surface file and reads it. The file is read once into memory; the parsers and the SHA-256
// see the same bytes; a file that is written to or replaced meanwhile is refused. Since a write stamps the file when it
// begins, one that was stamped just now is looked at again after a moment. The content decides on the format, because
// extensions lie and because a binary STL file may begin with any word; only OBJ has no mark of its own and goes by its
// extension.

#include "io/mesh/mesh_io.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "io/mesh/formats.h"
#include "io/mesh/sha256.h"

namespace lumenline {
namespace mesh {
namespace {

constexpr std::string_view kFormats = "STL, PLY, OBJ, OFF, VTK XML polydata (.vtp) and legacy VTK (.vtk)";

std::string lower_extension(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return extension;
}

// Keyword [ST][C][N][4|n]OFF, alone or before the counts; what of this is read is for the parser to say.
bool is_off_keyword(std::string_view word) {
    const std::size_t at = word.find("OFF");
    return at != std::string_view::npos && word.substr(0, at).find_first_not_of("STCN4n") == std::string_view::npos &&
           word.substr(at + 3).find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace

TriangleSoup parse_surface(const SourceFile& file) {
    if (file.bytes.empty()) fail_file(file, ErrorCode::kFileFormat, "expected a surface file, found an empty file");
    if (is_binary_stl(file)) return parse_stl(file);
    const std::string_view bytes = file.bytes;
    if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return parse_ply(file);
    if (is_word(bytes.substr(0, 14), "# vtk datafile")) return parse_vtk_legacy(file);

    const std::string extension = lower_extension(file.path);
    Cursor cursor(file, bytes.starts_with("\xEF\xBB\xBF") ? 3 : 0, Layout::kFree, '#');
    const std::string_view word = cursor.token();
    if (word.starts_with("<?xml") || word.starts_with("<VTKFile")) return parse_vtk_xml(file);
    if (is_word(word, "solid")) return parse_stl(file);
    if (is_off_keyword(word)) return parse_off(file);
    if (extension == ".stl") return parse_stl(file);
    if (extension == ".off") return parse_off(file);
    if (extension == ".obj") return parse_obj(file);
    if (extension == ".ply") return parse_ply(file);
    if (extension == ".vtk") return parse_vtk_legacy(file);
    if (extension == ".vtp") return parse_vtk_xml(file);
    fail_file(file, ErrorCode::kFileFormat,
              "expected one of the formats that are read, " + std::string(kFormats) + ", found extension " +
                  in_quotes(extension) + " and content that begins with " + in_quotes(bytes.substr(0, 16)));
}

namespace {

struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

struct Bytes {
    std::unique_ptr<char[]> data;
    std::size_t size = 0;
};

[[noreturn]] void fail_unreadable(const std::string& name, const std::string& why) {
    throw StageError(Stage::kLoad, ErrorCode::kFileUnreadable, name + ": expected a readable file, found that " + why);
}

/// What changes with every write to an open file, and when another one is renamed over it: it loses a link then.
using FileVersion = std::array<std::int64_t, 5>;

FileVersion version_of(std::FILE* file) {
    struct stat status {};
    if (::fstat(::fileno(file), &status) != 0) return {};
    return {status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec, status.st_ctim.tv_sec,
            status.st_ctim.tv_nsec};
}

/// How long ago a file must have been stamped for one reading to do: the call that stamped it may still be writing.
constexpr std::chrono::milliseconds kRest{50};

bool is_at_rest(std::FILE* file) {
    struct stat status {};
    if (::fstat(::fileno(file), &status) != 0) return false;
    const std::chrono::nanoseconds stamped =
        std::chrono::seconds(status.st_ctim.tv_sec) + std::chrono::nanoseconds(status.st_ctim.tv_nsec);
    return std::chrono::system_clock::now().time_since_epoch() - stamped > kRest;
}

/// Whether the file still holds what was read of it.
bool still_holds(std::FILE* file, std::string_view read) {
    std::array<char, 1 << 16> block{};
    for (std::size_t at = 0; at < read.size();) {
        const ssize_t got = ::pread(::fileno(file), block.data(), block.size(), static_cast<off_t>(at));
        if (got <= 0 || read.substr(at, static_cast<std::size_t>(got)) !=
                            std::string_view(block.data(), static_cast<std::size_t>(got)))
            return false;
        at += static_cast<std::size_t>(got);
    }
    return true;
}

Bytes read_bytes(const std::string& path, const std::string& name) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (error) fail_unreadable(name, "it cannot be opened (" + error.message() + ")");
    if (!std::filesystem::exists(status)) fail_unreadable(name, "it does not exist");
    if (!std::filesystem::is_regular_file(status)) fail_unreadable(name, "it is a directory or device");
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error) fail_unreadable(name, "its size is unknown (" + error.message() + ")");
    const std::unique_ptr<std::FILE, Closer> file(std::fopen(path.c_str(), "rb"));
    if (!file) fail_unreadable(name, "it cannot be opened (" + std::string(std::strerror(errno)) + ")");
    const FileVersion before = version_of(file.get());
    const bool rested = is_at_rest(file.get());
    Bytes bytes{std::make_unique_for_overwrite<char[]>(size), size};
    const std::size_t got = std::fread(bytes.data.get(), 1, size, file.get());
    if (got != size || std::fgetc(file.get()) != EOF || std::ferror(file.get()) != 0) {
        fail_unreadable(name, "reading stopped at byte " + std::to_string(got) + " of " + std::to_string(size) +
                                  " or the file changed meanwhile");
    }
    if (!rested) {
        const timespec rest{0, std::chrono::nanoseconds(kRest).count()};
        ::nanosleep(&rest, nullptr);
    }
    if (version_of(file.get()) != before || !(rested || still_holds(file.get(), {bytes.data.get(), size})))
        fail_unreadable(name, "it changed while it was read: run again when it is complete");
    return bytes;
}

}  // namespace
}  // namespace mesh

TriangleSoup read_surface(const std::string& path, const std::string& name) {
    const std::string& shown = name.empty() ? path : name;
    const mesh::Bytes bytes = mesh::read_bytes(path, shown);
    const std::string_view view(bytes.data.get(), bytes.size);
    try {
        TriangleSoup soup = mesh::parse_surface({shown, view});
        soup.source_file = shown;
        soup.source_sha256 = sha256_hex(view);
        return soup;
    } catch (const StageError& error) {
        throw SourceError(error, sha256_hex(view));
    }
}

}  // namespace lumenline
