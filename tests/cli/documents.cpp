// A fence is three or more backticks or tildes, closed by a line of at least as many of the same; a shorter one
// inside belongs to the text. The language is the first word behind the opening fence.
#include "tests/cli/documents.h"

#include <string_view>

#include "tests/cli/process.h"

namespace lumenline::cli_test {

namespace {

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// The backticks or tildes that a line begins with, if they are a fence.
std::string fence_of(const std::string& line) {
    if (line.empty() || (line[0] != '`' && line[0] != '~')) return "";
    const std::string fence = line.substr(0, line.find_first_not_of(line[0]));
    return fence.size() >= 3 ? fence : "";
}

}  // namespace

std::vector<DocumentedCommand> documented_commands(const std::string& markdown) {
    std::vector<DocumentedCommand> commands;
    std::string fence, language;  // of the block we are in; empty outside
    const std::vector<std::string> lines = lines_of(markdown);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        std::string line = trimmed(lines[i]);
        const std::string mark = fence_of(line);
        if (fence.empty()) {
            if (mark.empty()) continue;
            fence = mark;
            const std::string info = trimmed(line.substr(mark.size()));
            language = info.substr(0, info.find_first_of(" \t{"));
            continue;
        }
        if (!mark.empty() && mark[0] == fence[0] && mark.size() >= fence.size() && mark == line) {
            fence.clear();
            continue;
        }
        const std::size_t number = i + 1;
        while (line.ends_with('\\') && i + 1 < lines.size()) {
            line.pop_back();
            line += trimmed(lines[++i]);
        }
        if (language == "console") {
            if (!line.starts_with("$ ")) continue;
            line = trimmed(line.substr(2));
        } else if (language != "sh") {
            continue;
        }
        for (const std::string_view program : {"build/release/lumenline ", "./build/release/lumenline ", "lumenline "})
            if (line.starts_with(program)) commands.push_back({number, line.substr(program.size())});
    }
    return commands;
}

}  // namespace lumenline::cli_test
