// One handler answers everything before the library looks for routes of its own. Three traps of this version of the
// library: it compresses bodies of text with brotli on every request (so the page goes out as it was compressed when it
// was built, through a provider of known size), it believes any range, also one beyond the end, and several ranges at
// once come out wrong.
#include "engine/cli/serve.h"

#include <httplib.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "engine/cli/archive_files.h"
#include "io/archive/read.h"
#include "io/viewer/page.h"

namespace lumenline {

namespace {

using httplib::Request;
using httplib::Response;

constexpr const char* kLoopback = "127.0.0.1";
constexpr std::string_view kArchivePath = "/archive/";
constexpr int kForbidden = 403, kNotFound = 404, kNotAllowed = 405, kNoRange = 416;

/// The host a request names, without its port.
std::string_view host_of(std::string_view header) {
    if (header.starts_with('[')) return header.substr(0, header.find(']') + 1);
    return header.substr(0, header.find(':'));
}

bool names_this_machine(const Request& request) {
    if (request.get_header_value_count("Host") != 1) return false;
    const std::string header = request.get_header_value("Host");
    const std::string_view host = host_of(header);
    return host == "localhost" || host == kLoopback || host == "[::1]";
}

/// Whether the one range that a request may have lies within `size` bytes; -1 stands for an end that is left open.
bool range_fits(const Request& request, std::uint64_t size) {
    if (request.ranges.empty()) return true;
    if (request.ranges.size() > 1) return false;
    const auto [first, last] = request.ranges.front();
    const auto end = static_cast<ssize_t>(size);
    if (first == -1) return last > 0 && last <= end;
    return first >= 0 && first < end && (last == -1 || (last >= first && last < end));
}

void refuse(Response& response, int status, const char* sentence) {
    response.status = status;
    response.set_content(std::string(sentence) + "\n", "text/plain; charset=utf-8");
}

void set_headers(Response& response) {
    response.set_header("Content-Security-Policy", std::string(page_policy()));
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("X-Frame-Options", "DENY");
    response.set_header("Referrer-Policy", "no-referrer");
    response.set_header("Cross-Origin-Opener-Policy", "same-origin");
    response.set_header("Cross-Origin-Resource-Policy", "same-origin");
    response.set_header("Cache-Control", "no-store");
}

/// Gives what was compressed when the page was built.
void give_packed(std::string_view packed, const char* type, const Request& request, Response& response) {
    if (!request.ranges.empty()) return refuse(response, kNoRange, "This is given whole.");
    const bool as_it_is = request.get_header_value("Accept-Encoding").find("gzip") != std::string::npos;
    if (as_it_is) response.set_header("Content-Encoding", "gzip");
    const auto plain = as_it_is ? nullptr : std::make_shared<const std::string>(unpacked(packed));
    const std::string_view bytes = as_it_is ? packed : *plain;
    response.set_content_provider(bytes.size(), type,
                                  [plain, bytes](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                      return sink.write(bytes.data() + offset, length);
                                  });
}

void give_file(const ArchiveFiles& files, const Request& request, Response& response) {
    const std::shared_ptr<const OpenFile> file = files.open(request.path.substr(kArchivePath.size()));
    if (!file) return refuse(response, kNotFound, "The archive has no such file.");
    response.set_header("ETag", file->tag());
    if (!range_fits(request, file->size()) || file->size() == 0)
        return refuse(response, kNoRange, "One range within the file can be asked for.");
    response.set_content_provider(file->size(), "application/x-hdf5",
                                  [file](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                      std::vector<char> block(std::min<std::size_t>(length, std::size_t{1} << 20));
                                      const std::size_t got = file->read(offset, block);
                                      return got > 0 && sink.write(block.data(), got);
                                  });
}

void answer(const ArchiveFiles& files, const Request& request, Response& response) {
    set_headers(response);
    if (!names_this_machine(request))
        return refuse(response, kForbidden, "This server answers to localhost and 127.0.0.1 only.");
    if (request.method != "GET" && request.method != "HEAD")
        return refuse(response, kNotAllowed, "The archive can only be read.");
    if (request.path == "/") return give_packed(page_gzip(), "text/html; charset=utf-8", request, response);
    if (request.path == "/hdf5.wasm") return give_packed(page_library_gzip(), "application/wasm", request, response);
    if (request.path == "/archive.json") {
        const nlohmann::json about{{"root", files.root()}, {"name", files.name()}};
        const auto replace = nlohmann::json::error_handler_t::replace;
        return response.set_content(about.dump(-1, ' ', false, replace), "application/json");
    }
    if (std::string_view(request.path).starts_with(kArchivePath)) return give_file(files, request, response);
    refuse(response, kNotFound, "There is no such page.");
}

/// Nothing is open for writing, so the process may end where it stands.
void end_process(int /*signal*/) { std::_Exit(EXIT_SUCCESS); }

int bind(httplib::Server& server, int wanted) {
    if (server.bind_to_port(kLoopback, wanted == 0 ? kUsualPort : wanted)) return wanted == 0 ? kUsualPort : wanted;
    if (wanted != 0)
        throw std::runtime_error("port " + std::to_string(wanted) +
                                 " of 127.0.0.1 is in use or not allowed: choose another one with --port");
    const int port = server.bind_to_any_port(kLoopback);
    if (port <= 0) throw std::runtime_error("no port of 127.0.0.1 can be listened on");
    return port;
}

}  // namespace

void serve_archive(const std::filesystem::path& archive, const ServeOptions& options,
                   const std::function<void(const std::string&)>& said) {
    const ArchiveFiles files(archive);
    // A file that is none of ours is refused here, in one sentence, rather than in the browser.
    ArchiveFile(std::filesystem::is_directory(archive) ? archive / files.root() : archive);
    httplib::Server server;
    server.set_keep_alive_max_count(1000);
    // The library lets several servers share a port, of which one would get the requests meant for another.
    server.set_socket_options([](socket_t) {});
    server.set_pre_routing_handler([&files](const Request& request, Response& response) {
        answer(files, request, response);
        return httplib::Server::HandlerResponse::Handled;
    });
    const int port = bind(server, options.port);
    std::signal(SIGINT, end_process);
    std::signal(SIGTERM, end_process);
    said("http://" + std::string(kLoopback) + ":" + std::to_string(port) + "/");
    if (!server.listen_after_bind()) throw std::runtime_error("the server cannot accept connections any longer");
}

}  // namespace lumenline
