// Input and output go through unnamed files rather than pipes: nothing has to be read while the program runs.

#include "engine/cli/command.h"

#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <system_error>

namespace lumenline {

namespace {

struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

File unnamed_file(const std::string& contents = "") {
    File file(std::tmpfile());
    if (!file || std::fwrite(contents.data(), 1, contents.size(), file.get()) != contents.size() ||
        std::fflush(file.get()) != 0)
        throw std::system_error(errno, std::generic_category(), "cannot make a temporary file");
    std::rewind(file.get());
    return file;
}

std::string contents_of(std::FILE* file) {
    std::string text;
    std::array<char, 4096> buffer{};
    std::rewind(file);
    for (std::size_t got = 0; (got = std::fread(buffer.data(), 1, buffer.size(), file)) > 0;)
        text.append(buffer.data(), got);
    return text;
}

pid_t start(const std::vector<std::string>& words, const std::array<std::FILE*, 3>& files) {
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    for (int descriptor = 0; descriptor < 3; ++descriptor)
        ::posix_spawn_file_actions_adddup2(&actions, ::fileno(files.at(static_cast<std::size_t>(descriptor))),
                                           descriptor);
    std::vector<std::string> copies = words;
    std::vector<char*> argv;
    for (std::string& word : copies) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_t process = -1;
    const int error = ::posix_spawnp(&process, argv.front(), &actions, nullptr, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::system_error(error, std::generic_category(), "cannot run '" + words.front() + "'");
    return process;
}

}  // namespace

CommandResult run_command(const std::vector<std::string>& words, const std::string& input) {
    constexpr std::chrono::seconds kLongest{30};
    constexpr int kMilliseconds = 5;
    const File in = unnamed_file(input), out = unnamed_file(), err = unnamed_file();
    const pid_t process = start(words, {in.get(), out.get(), err.get()});
    const auto end = std::chrono::steady_clock::now() + kLongest;
    int status = 0;
    while (::waitpid(process, &status, WNOHANG) == 0) {
        if (std::chrono::steady_clock::now() > end) ::kill(process, SIGKILL);
        ::poll(nullptr, 0, kMilliseconds);
    }
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents_of(out.get()), contents_of(err.get())};
}

}  // namespace lumenline
