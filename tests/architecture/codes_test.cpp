// The table of codes in io/ARCHIVE.md against the codes in the sources: each stands in it with its severity, and
// none more.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "tests/architecture/rules.h"

namespace lumenline::architecture {
namespace {

using Codes = std::map<std::string, std::set<std::string>>;  // code -> severities

void add_matches(const std::string& text, const char* pattern, Codes& codes,
                 const std::map<std::string, std::string>& severities) {
    const std::regex regex(pattern);
    for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match)
        codes[(*match)[2]].insert(severities.at((*match)[1]));
}

/// Findings that stages make, and the names of failures.
Codes codes_of_sources(const Tree& tree) {
    Codes codes;
    for (const auto& [path, text] : tree) {
        if (!path.ends_with(".cpp")) continue;
        add_matches(text, R"(\.(note|warn|error)\(\s*"([a-z_]+)\")", codes,
                    {{"note", "note"}, {"warn", "warning"}, {"error", "error"}});
        add_matches(text, R"((note)_count\(\w+, "([a-z_]+)\")", codes, {{"note", "note"}});
        if (path == "engine/core/errors.cpp")
            add_matches(text, R"((case ErrorCode)::\w+: return "([a-z_]+)\")", codes, {{"case ErrorCode", "failure"}});
    }
    return codes;
}

Codes codes_of_document(const std::string& text) {
    Codes codes;
    std::istringstream lines(text);
    bool inside = false;
    const std::regex row(R"(\| `([a-z_]+)` \| ([a-z, ]+) \| [^|]+ \| [^|]+ \|)");
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("## ")) inside = line == "## Codes";
        std::smatch cells;
        if (!inside || !std::regex_match(line, cells, row)) continue;
        std::istringstream severities(cells[2]);
        for (std::string severity; std::getline(severities >> std::ws, severity, ',');)
            codes[cells[1]].insert(severity);
    }
    return codes;
}

std::string listed(const Codes& codes) {
    std::string text;
    for (const auto& [code, severities] : codes)
        for (const std::string& severity : severities) text += code + ": " + severity + "\n";
    return text;
}

std::string document() {
    std::ifstream file(std::string(LUMENLINE_SOURCE_DIR) + "/io/ARCHIVE.md");
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Codes, DocumentListsThoseOfTheSourcesAndNoMore) {
    const Codes codes = codes_of_sources(read_tree(LUMENLINE_SOURCE_DIR, {"engine", "io", "config"}));
    EXPECT_GT(codes.size(), 50U);
    EXPECT_EQ(listed(codes_of_document(document())), listed(codes));
}

/// Codes that no test names, failures by their name in the sources or in archives.
std::string untested(const Codes& codes, const std::string& errors, const Tree& tests) {
    std::map<std::string, std::string> names;  // of failures: code -> enumerator
    const std::regex line(R"(case (ErrorCode::\w+): return "([a-z_]+)\")");
    for (std::sregex_iterator match(errors.begin(), errors.end(), line), end; match != end; ++match)
        names[(*match)[2]] = (*match)[1];
    std::string missing;
    for (const auto& [code, severities] : codes) {
        const auto is_named = [&, quoted = "\"" + code + "\""](const auto& file) {
            if (file.first.ends_with("codes_test.cpp")) return false;
            if (file.second.find(quoted) != std::string::npos) return true;
            const auto name = names.find(code);
            return name != names.end() && file.second.find(name->second) != std::string::npos;
        };
        if (std::none_of(tests.begin(), tests.end(), is_named)) missing += code + "\n";
    }
    return missing;
}

TEST(Codes, TestsNameEachOfThem) {
    const Tree engine = read_tree(LUMENLINE_SOURCE_DIR, {"engine"}), tests = read_tree(LUMENLINE_SOURCE_DIR, {"tests"});
    const std::string errors = engine.at("engine/core/errors.cpp");
    const Codes codes = codes_of_document(document());
    EXPECT_EQ(untested(codes, errors, tests), "");
    EXPECT_EQ(untested({{"alpha", {"note"}}, {"beta", {"failure"}}, {"gamma", {"note"}}},
                       "case ErrorCode::kBeta: return \"beta\"",
                       {{"a_test.cpp", "has(\"alpha\")"}, {"b_test.cpp", "ErrorCode::kBeta gamma"}}),
              "gamma\n");
}

TEST(Codes, CheckSeesFaults) {
    const std::string text = document();
    const auto edited = [&](const std::string& from, const std::string& to) {
        std::string other = text;
        EXPECT_NE(other.find(from), std::string::npos) << from;
        return listed(codes_of_document(other.replace(other.find(from), from.size(), to)));
    };
    const std::string all = listed(codes_of_document(text));
    EXPECT_NE(edited("| `hole_filled` | warning", "| `hole_filled` | note"), all);
    EXPECT_NE(edited("| `hole_filled` |", "| `hole_mended` |"), all);
    EXPECT_NE(edited("\n| `no_volume`", "\n `no_volume`"), all);
    const Codes made = codes_of_sources(
        {{"engine/a.cpp",
          "context.note(\n    \"alpha\", x); context_.error(\"beta\"); note_count(context, \"gamma\", 1);"}});
    EXPECT_EQ(listed(made), "alpha: note\nbeta: error\ngamma: note\n");
}

}  // namespace
}  // namespace lumenline::architecture
