#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace lumenline::cli_test {

/// What a finished child process left behind.
struct Finished {
    int status = -1;       ///< exit status; -1 if a signal ended it
    int signal = 0;        ///< that signal; 0 = none
    std::string out, err;  ///< standard output and standard error
};

/// A child process in its own folder, with its output gathered in files, so that it never waits for a reader.
class Process {
public:
    /// @param argv    the program's path first
    /// @param folder  its working directory
    Process(const std::vector<std::string>& argv, const std::filesystem::path& folder);
    /// Kills the child if nobody waited for it.
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    [[nodiscard]] pid_t id() const { return child_; }
    void send(int signal) const;
    [[nodiscard]] bool running();
    Finished wait();

private:
    void note(int wait_status);

    pid_t child_ = -1;
    bool done_ = false;
    Finished finished_;
    std::filesystem::path out_, err_;
};

/// Runs the program under test with `arguments` in `folder` to its end.
Finished run_lumenline(const std::vector<std::string>& arguments, const std::filesystem::path& folder);

/// Runs a line of shell with bash, where a failure anywhere in a pipe is the line's failure.
Finished run_shell(const std::string& line, const std::filesystem::path& folder);

/// An empty folder of this test's own below ::testing::TempDir().
std::filesystem::path fresh_folder();

std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, const std::string& text);

/// The lines of a text, without their ends.
std::vector<std::string> lines_of(const std::string& text);

}  // namespace lumenline::cli_test
