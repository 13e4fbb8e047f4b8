// The page in one file: the archive's bytes as they are, as base64 in blocks of data, which browsers keep but do not
// run. They are streamed from file to file, since an archive may be larger than one likes to hold in memory.
#include "io/viewer/page.h"

#include <array>
#include <cstdint>
#include <ostream>
#include <set>
#include <span>
#include <stdexcept>

#include "engine/cli/archive_files.h"
#include "engine/cli/serve.h"
#include "io/archive/commit.h"
#include "io/archive/read.h"
#include "io/archive/utf8.h"

namespace lumenline {

namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{256} << 20;  // browsers hold the text of a page about four times

void append_base64(std::span<const char> bytes, std::string& text) {
    static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63U];
    }
}

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '"')
            out += "&quot;";
        else if (c == '<')
            out += "&lt;";
        else
            out += c;
    }
    return out;
}

struct Part {
    std::string path;
    std::shared_ptr<const OpenFile> file;
};

std::vector<Part> parts_of(const std::filesystem::path& archive, const ArchiveFiles& files,
                           const std::vector<std::string>& wanted) {
    std::vector<Part> parts{{files.root(), files.open(files.root())}};
    if (!std::filesystem::is_directory(archive)) {
        if (!wanted.empty())
            throw UnknownName(
                "'" + archive.string() +
                "' is one file, which comes along whole: leave --model out, or give the archive's directory");
        return parts;
    }
    for (const std::string& id : wanted) open_model(archive, id);
    const std::set<std::string> only(wanted.begin(), wanted.end());
    for (const ModelSummary& model : list_models(archive)) {
        if (!only.empty() && !only.contains(model.identity.id)) continue;
        const std::string path = "models/" + model.identity.id + ".hdf";
        if (auto file = files.open(path)) parts.push_back({path, std::move(file)});
    }
    return parts;
}

void require_small(const std::vector<Part>& parts) {
    std::uint64_t size = 0;
    for (const Part& part : parts) size += part.file->size();
    if (size > kMostBytes)
        throw ArchiveError("the archive has " + std::to_string(size >> 20) + " MiB, and a page holds up to " +
                           std::to_string(kMostBytes >> 20) +
                           ": choose models with --model, take --empty and open the archive in the page, or use serve");
}

/// The page has no server to ask for the library.
void write_library(std::ostream& out) {
    std::string text;
    append_base64(page_library_gzip(), text);
    out << "<script type=\"application/octet-stream\" id=\"hdf5-library\">" << text << "</script>\n    ";
}

void write_part(const Part& part, const std::string& name, std::ostream& out) {
    out << "<script type=\"application/octet-stream\" data-lumenline-file=\"" << escaped(valid_text(part.path))
        << "\" data-lumenline-name=\"" << escaped(name) << "\">";
    std::array<char, 3 << 15> block{};  // whole groups of base64
    std::string text;
    for (std::uint64_t offset = 0; offset < part.file->size();) {
        const std::size_t got = part.file->read(offset, block);
        if (got == 0) throw ArchiveError("cannot read '" + printable(part.path) + "' of the archive to its end");
        text.clear();
        append_base64(std::span(block).first(got), text);
        out << text;
        offset += got;
    }
    out << "</script>\n    ";
}

}  // namespace

void write_page(const std::filesystem::path& archive, const std::filesystem::path& file, const PageOptions& options) {
    refuse_overwriting(file, archive);
    const ArchiveFiles files(archive);
    const std::string html = unpacked(page_gzip());
    const std::size_t mark = html.find(kBlocksMark);
    if (mark == std::string::npos) throw std::runtime_error("the built-in page is damaged: build the program again");
    const std::vector<Part> parts = options.empty ? std::vector<Part>{} : parts_of(archive, files, options.models);
    require_small(parts);
    write_file(file, [&](std::ostream& out) {
        out << std::string_view(html).substr(0, mark);
        write_library(out);
        for (const Part& part : parts) write_part(part, files.name(), out);
        out << std::string_view(html).substr(mark + kBlocksMark.size());
    });
}

}  // namespace lumenline
