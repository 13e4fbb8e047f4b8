// The includes are read from the text, not from the compiler's view: a forbidden include in a branch of the
// preprocessor that is not compiled here counts too. A header may name a heavy library only while it is private
// to its room, that is while no file of another room reaches it, through however many headers of ours.
#include "tests/architecture/rules.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace lumenline::architecture {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHeaderLines = 150;
constexpr std::size_t kSourceLines = 400;

struct Include {
    std::size_t line;
    char quote;  // '"' or '<'; '?' for one whose name is made by a macro
    std::string name;
};

/// A library, by the start of the names of its headers, and the rooms whose sources may include it.
struct Library {
    std::string name;
    std::vector<std::string> headers;
    std::set<std::string> rooms;
};

const std::set<std::string>& stages() {
    static const std::set<std::string> rooms{"engine/condition", "engine/voronoi", "engine/endpoints",
                                             "engine/eikonal",   "engine/trace",   "engine/characterize",
                                             "engine/branches"};
    return rooms;
}

const std::vector<Library>& libraries() {
    static const std::vector<Library> all{
        {"CGAL", {"CGAL/"}, {"engine/geometry", "engine/condition", "engine/voronoi", "engine/phantom"}},
        {"oneTBB", {"tbb/", "oneapi/tbb"}, {"engine/schedule"}},
        {"threads", {"thread", "future", "execution", "condition_variable", "pthread.h", "omp.h"}, {"engine/schedule"}},
        {"HDF5", {"hdf5", "H5"}, {"io/archive"}},
        {"yaml-cpp", {"yaml-cpp/"}, {"config"}},
        {"OpenMesh", {"OpenMesh/"}, {"engine/condition", "io/mesh"}},
        {"OpenSSL", {"openssl/"}, {"io/mesh", "io/export"}},
        {"pugixml", {"pugixml"}, {"io/mesh"}},
        {"zlib", {"zlib.h"}, {"io/archive", "io/mesh", "io/viewer"}},
        {"libpng", {"png.h", "libpng"}, {"io/export"}},
        {"CLI11", {"CLI/"}, {"engine/cli"}},
        {"cpp-httplib", {"httplib"}, {"engine/cli"}},
        {"VTK", {"vtk"}, {}},
        {"GoogleTest", {"gtest/", "gmock/", "benchmark/"}, {}},
    };
    return all;
}

bool is_header(const std::string& path) { return path.ends_with(".h"); }
bool is_source(const std::string& path) { return path.ends_with(".cpp"); }
bool is_ours(const std::string& name) {
    return name.starts_with("engine/") || name.starts_with("io/") || name.starts_with("config/");
}

/// "engine/trace", "io/archive", "config"; what a file in `engine/` itself belongs to is "engine".
std::string room_of(const std::string& path) {
    if (path.starts_with("config/")) return "config";
    const std::size_t first = path.find('/');
    const std::size_t second = path.find('/', first + 1);
    return path.substr(0, second == std::string::npos ? first : second);
}

/// The rooms that a room may include besides itself; null if there is no rule for it.
const std::set<std::string>* visible_from(const std::string& room) {
    static const std::set<std::string> nothing;
    static const std::set<std::string> core{"engine/core"};
    static const std::set<std::string> kernels{"engine/core", "engine/geometry"};
    static const std::set<std::string> io{"engine/core", "io/mesh", "io/archive"};
    static const std::set<std::string> schedule = [] {
        std::set<std::string> rooms = stages();
        rooms.insert("engine/core");
        return rooms;
    }();
    static const std::set<std::string> cli = [] {
        std::set<std::string> rooms = schedule;
        rooms.insert({"engine/geometry", "engine/phantom", "engine/population", "engine/schedule", "io/mesh",
                      "io/archive", "io/export", "io/viewer", "config"});
        return rooms;
    }();
    if (room == "engine/core") return &nothing;
    if (room == "engine/geometry" || room == "engine/population" || room == "config" || room == "io/viewer") return &core;
    if (room == "engine/phantom" || stages().contains(room)) return &kernels;
    if (room == "engine/schedule") return &schedule;
    if (room == "engine/cli") return &cli;
    if (room == "io/mesh" || room == "io/archive" || room == "io/export") return &io;
    return nullptr;
}

std::vector<Include> includes_of(const std::string& text) {
    static const std::regex directive(R"(^\s*#\s*(?:include|include_next|import)\b\s*(.*)$)");
    std::vector<Include> found;
    std::istringstream lines(text);
    std::string line;
    for (std::size_t number = 1; std::getline(lines, line); ++number) {
        std::smatch match;
        if (!std::regex_search(line, match, directive)) continue;
        const std::string rest = match[1];
        const char open = rest.empty() ? '?' : rest.front();
        const std::size_t end = open == '"' ? rest.find('"', 1) : open == '<' ? rest.find('>', 1) : std::string::npos;
        if (end == std::string::npos)
            found.push_back({number, '?', rest});
        else
            found.push_back({number, open, rest.substr(1, end - 1)});
    }
    return found;
}

const Library* library_of(const std::string& name) {
    for (const Library& library : libraries())
        for (const std::string& header : library.headers) {
            // A folder, or the first letters of names like H5public.h; standard headers are named in full.
            const bool standard = library.name == "threads";
            if (standard ? name == header : name.starts_with(header)) return &library;
        }
    return nullptr;
}

std::string place(const std::string& path, std::size_t line) { return path + ":" + std::to_string(line) + ": "; }

class Checker {
public:
    explicit Checker(const Tree& tree) : tree_(tree) {
        for (const auto& [path, text] : tree)
            if (is_header(path) || is_source(path)) includes_[path] = includes_of(text);
    }

    Violations check() {
        for (const auto& [path, includes] : includes_) {
            room_ = room_of(path);
            visible_ = visible_from(room_);
            if (visible_ == nullptr) {
                report(place(path, 1) + "there is no rule for what " + room_ + " may include");
                continue;
            }
            for (const Include& include : includes) check(path, include);
            check_reach(path);
        }
        return std::move(violations_);
    }

private:
    void report(std::string sentence) { violations_.push_back(std::move(sentence)); }

    void check(const std::string& path, const Include& include) {
        const std::string where = place(path, include.line);
        if (include.quote == '?') {
            report(where + "an include whose name cannot be read: " + include.name);
        } else if (is_ours(include.name)) {
            if (include.quote == '<') report(where + "own header " + include.name + " in angle brackets");
            const std::string other = room_of(include.name);
            if (other != room_ && !visible_->contains(other)) report(where + room_ + " may not include " + other);
            if (is_source(include.name)) report(where + "includes the source " + include.name);
        } else if (include.quote == '"') {
            report(where + "own header " + include.name + " is not named from the repository's root");
        } else if (const Library* library = library_of(include.name)) {
            if (!library->rooms.contains(room_)) report(where + library->name + " has no place in " + room_);
        }
    }

    /// Heavy libraries that a file gets from the headers of other rooms.
    void check_reach(const std::string& path) {
        std::set<std::string> seen;
        std::vector<std::string> open{path};
        while (!open.empty()) {
            const std::string from = open.back();
            open.pop_back();
            const auto found = includes_.find(from);
            if (!seen.insert(from).second || found == includes_.end()) continue;
            for (const Include& include : found->second) {
                if (is_ours(include.name)) open.push_back(include.name);
                const Library* library = include.quote == '<' ? library_of(include.name) : nullptr;
                if (library != nullptr && room_of(from) != room_)
                    report(place(from, include.line) + library->name + " is in a header that " + path + " reaches");
            }
        }
    }

    const Tree& tree_;
    std::map<std::string, std::vector<Include>> includes_;
    std::string room_;
    const std::set<std::string>* visible_ = nullptr;
    Violations violations_;
};

}  // namespace

Tree read_tree(const fs::path& root, const std::vector<std::string>& folders) {
    Tree tree;
    for (const std::string& folder : folders) {
        for (auto it = fs::recursive_directory_iterator(root / folder); it != fs::recursive_directory_iterator(); ++it) {
            const fs::directory_entry& entry = *it;
            const fs::path& path = entry.path();
            if (path.filename() == "node_modules") it.disable_recursion_pending();  // npm's, not ours
            const bool wanted = path.extension() == ".h" || path.extension() == ".cpp" || path.extension() == ".hpp" ||
                                path.extension() == ".cc" || path.filename() == "CMakeLists.txt";
            if (!entry.is_regular_file() || !wanted) continue;
            std::ifstream file(path, std::ios::binary);
            if (!file) throw std::runtime_error("cannot read " + path.string());
            tree[fs::relative(path, root).generic_string()] = {std::istreambuf_iterator<char>(file), {}};
        }
    }
    return tree;
}

Violations include_violations(const Tree& tree) { return Checker(tree).check(); }

Violations size_violations(const Tree& tree) {
    Violations violations;
    for (const auto& [path, text] : tree) {
        const bool header = is_header(path) || path.ends_with(".hpp");
        if (!header && !is_source(path) && !path.ends_with(".cc")) continue;
        const auto breaks = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
        const std::size_t lines = breaks + (text.empty() || text.back() == '\n' ? 0 : 1);
        const std::size_t limit = header ? kHeaderLines : kSourceLines;
        if (lines > limit)
            violations.push_back(path + ": " + std::to_string(lines) + " lines, the limit is " + std::to_string(limit));
    }
    return violations;
}

Violations wording_violations(const Tree& tree) {
    // Put together here, so that this file does not report itself.
    static const std::regex mark(std::string(R"(\b(TO)") + "DO|FIX" + "ME|XX" + R"(X)\b)");
    Violations violations;
    for (const auto& [path, text] : tree) {
        std::istringstream lines(text);
        std::string line;
        for (std::size_t number = 1; std::getline(lines, line); ++number)
            if (std::regex_search(line, mark)) violations.push_back(place(path, number) + "unfinished: " + line);
    }
    return violations;
}

Violations listing_violations(const Tree& tree) {
    Violations violations;
    for (const auto& [path, text] : tree) {
        if (!is_source(path)) continue;
        bool listed = false;
        for (fs::path folder = fs::path(path).parent_path(); !listed && !folder.empty();
             folder = folder.parent_path()) {
            const auto lists = tree.find((folder / "CMakeLists.txt").generic_string());
            if (lists == tree.end()) continue;
            const std::string name = fs::path(path).lexically_relative(folder).generic_string();
            const std::regex word("(^|[\\s/(])" + std::regex_replace(name, std::regex(R"([.+])"), R"(\$&)") +
                                  "($|[\\s)])");
            listed = std::regex_search(lists->second, word);
        }
        if (!listed) violations.push_back(path + ": no CMakeLists.txt lists it");
    }
    return violations;
}

}  // namespace lumenline::architecture
