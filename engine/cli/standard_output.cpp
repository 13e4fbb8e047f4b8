// `lumenline browse ... | head` closes the pipe while we still write. By default that kills the
// process by SIGPIPE, and std::cout hides which error it met. So the signal is ignored for as long
// as we write, and a stream buffer of our own writes to the descriptor and throws what went wrong;
// a stream whose exceptions include badbit hands that exception on.

#include "engine/cli/standard_output.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <ostream>
#include <streambuf>
#include <system_error>

namespace lumenline {

namespace {

class IgnoredPipeSignal {
public:
    IgnoredPipeSignal() : before_(std::signal(SIGPIPE, SIG_IGN)) {}
    ~IgnoredPipeSignal() { std::signal(SIGPIPE, before_); }
    IgnoredPipeSignal(const IgnoredPipeSignal&) = delete;
    IgnoredPipeSignal& operator=(const IgnoredPipeSignal&) = delete;

private:
    void (*before_)(int);
};

class DescriptorBuffer : public std::streambuf {
public:
    explicit DescriptorBuffer(int descriptor) : descriptor_(descriptor) {
        setp(buffer_.data(), buffer_.data() + buffer_.size());
    }

protected:
    int_type overflow(int_type character) override {
        flush();
        if (!traits_type::eq_int_type(character, traits_type::eof())) sputc(traits_type::to_char_type(character));
        return traits_type::not_eof(character);
    }
    int sync() override {
        flush();
        return 0;
    }

private:
    void flush() {
        for (const char* from = pbase(); from < pptr();) {
            const ssize_t written = ::write(descriptor_, from, static_cast<std::size_t>(pptr() - from));
            if (written >= 0)
                from += written;
            else if (errno != EINTR)
                throw std::system_error(errno, std::generic_category(), "cannot write to standard output");
        }
        setp(buffer_.data(), buffer_.data() + buffer_.size());
    }

    int descriptor_;
    std::array<char, 65536> buffer_{};
};

}  // namespace

bool to_standard_output(const std::function<void(std::ostream&)>& body) {
    const IgnoredPipeSignal ignored;
    DescriptorBuffer buffer(STDOUT_FILENO);
    std::ostream out(&buffer);
    out.exceptions(std::ios::badbit | std::ios::failbit);
    try {
        body(out);
        out.flush();
    } catch (const std::system_error& error) {
        if (error.code() == std::errc::broken_pipe) return false;
        throw;
    }
    return true;
}

}  // namespace lumenline
