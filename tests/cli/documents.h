#pragma once

#include <string>
#include <vector>

namespace lumenline::cli_test {

/// A command line of ours in a document.
struct DocumentedCommand {
    std::size_t line = 0;   ///< in the document, from 1
    std::string arguments;  ///< what stands behind the program's name, as the shell is to read it
};

/// The command lines in the fenced `sh` and `console` blocks of a Markdown text that start with `lumenline` or
/// `build/release/lumenline`. In `console` blocks only lines after a `$ ` are commands. Lines that end in a
/// backslash are joined with the next one; all other lines are left alone.
std::vector<DocumentedCommand> documented_commands(const std::string& markdown);

}  // namespace lumenline::cli_test
