// posix_spawn has no portable way to set the working directory, so this forks; the child does nothing but
// calls that are safe between fork and exec. It gets default signals: a test
// program may be started with SIGINT ignored, and the child would inherit that.
#include "tests/cli/process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <system_error>

namespace lumenline::cli_test {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void become(char* const* argv, const char* folder, const char* out, const char* err) {
    for (const int signal : {SIGINT, SIGTERM, SIGPIPE}) std::signal(signal, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that is killed leaves no children
    const int in_fd = open("/dev/null", O_RDONLY);
    const int out_fd = open(out, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    const int err_fd = open(err, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    const bool ready = in_fd >= 0 && out_fd >= 0 && err_fd >= 0 && dup2(in_fd, 0) == 0 && dup2(out_fd, 1) == 1 &&
                       dup2(err_fd, 2) == 2 && chdir(folder) == 0;
    if (ready) execv(argv[0], argv);
    _exit(127);
}

}  // namespace

Process::Process(const std::vector<std::string>& argv, const fs::path& folder) {
    static int count = 0;
    const std::string stem = "child-" + std::to_string(getpid()) + "-" + std::to_string(++count);
    out_ = fs::path(::testing::TempDir()) / (stem + ".out");
    err_ = fs::path(::testing::TempDir()) / (stem + ".err");
    std::vector<std::string> copies = argv;
    std::vector<char*> pointers;
    for (std::string& copy : copies) pointers.push_back(copy.data());
    pointers.push_back(nullptr);
    // A child that is killed at once has opened nothing yet; what it said is empty all the same.
    for (const fs::path& file : {out_, err_}) std::ofstream(file, std::ios::trunc);
    child_ = fork();
    if (child_ < 0) throw std::system_error(errno, std::generic_category(), "cannot fork");
    if (child_ == 0) become(pointers.data(), folder.c_str(), out_.c_str(), err_.c_str());
}

Process::~Process() {
    if (!done_) {
        kill(child_, SIGKILL);
        int status = 0;
        waitpid(child_, &status, 0);
    }
    std::error_code ignored;
    fs::remove(out_, ignored);
    fs::remove(err_, ignored);
}

void Process::send(int signal) const { kill(child_, signal); }

void Process::note(int wait_status) {
    done_ = true;
    if (WIFEXITED(wait_status)) finished_.status = WEXITSTATUS(wait_status);
    if (WIFSIGNALED(wait_status)) finished_.signal = WTERMSIG(wait_status);
    finished_.out = read_text(out_);
    finished_.err = read_text(err_);
}

bool Process::running() {
    int status = 0;
    if (!done_ && waitpid(child_, &status, WNOHANG) == child_) note(status);
    return !done_;
}

Finished Process::wait() {
    int status = 0;
    while (!done_) {
        if (waitpid(child_, &status, 0) == child_)
            note(status);
        else if (errno != EINTR)
            throw std::system_error(errno, std::generic_category(), "cannot wait for a child process");
    }
    return finished_;
}

Finished run_lumenline(const std::vector<std::string>& arguments, const fs::path& folder) {
    std::vector<std::string> argv{LUMENLINE_BINARY};
    argv.insert(argv.end(), arguments.begin(), arguments.end());
    return Process(argv, folder).wait();
}

Finished run_shell(const std::string& line, const fs::path& folder) {
    return Process({"/bin/bash", "-c", "set -o pipefail\n" + line}, folder).wait();
}

fs::path fresh_folder() {
    const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("lumenline-") + test->test_suite_name() + "-" + test->name();
    for (char& c : name)
        if (c == '/') c = '-';
    const fs::path folder = fs::path(::testing::TempDir()) / (name + "-" + std::to_string(getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
}

std::string read_text(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw std::runtime_error("cannot read " + file.string());
    return {std::istreambuf_iterator<char>(in), {}};
}

void write_text(const fs::path& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary);
    out << text;
    out.close();
    if (!out) throw std::runtime_error("cannot write " + file.string());
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

}  // namespace lumenline::cli_test
