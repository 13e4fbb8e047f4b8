// The corpus of the fuzzers through every reader, as it is and changed in a fixed way: bytes flipped, stretches
// cut, repeated and spliced with another file, numbers replaced by ones that are dear to overflow.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "tests/fuzz/feed.h"

namespace lumenline::fuzz {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string>& corpus() {
    static const std::vector<std::string> files = [] {
        std::vector<fs::path> paths;
        for (const auto& entry : fs::recursive_directory_iterator(LUMENLINE_SOURCE_DIR "/tests/fuzz/corpus")) {
            if (entry.is_regular_file()) paths.push_back(entry.path());
        }
        std::sort(paths.begin(), paths.end());
        std::vector<std::string> contents;
        for (const fs::path& path : paths) {
            std::ifstream file(path, std::ios::binary);
            contents.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
        }
        return contents;
    }();
    return files;
}

class Mutator {
public:
    explicit Mutator(std::uint32_t seed) : random_(seed) {}

    std::string change(std::string bytes) {
        for (std::size_t changes = 1 + below(3); changes > 0 && !bytes.empty(); --changes) {
            const std::size_t at = below(bytes.size());
            switch (below(6)) {
                case 0: bytes[at] = static_cast<char>(random_()); break;
                case 1: bytes[at] = static_cast<char>(static_cast<unsigned char>(bytes[at]) ^ 1U << below(8)); break;
                case 2: bytes.erase(at, 1 + below(bytes.size() - at)); break;
                case 3: bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(64))); break;
                case 4: overwrite(bytes, at); break;
                default: splice(bytes, at);
            }
        }
        return bytes;
    }

private:
    std::size_t below(std::size_t limit) { return random_() % limit; }

    // Binary or decimal extremes over the number that stands there.
    void overwrite(std::string& bytes, std::size_t at) {
        static const std::array<std::string, 8> kExtremes{"-1",
                                                          "0",
                                                          "4294967295",
                                                          "9223372036854775807",
                                                          "18446744073709551616",
                                                          std::string(4, '\xFF'),
                                                          std::string(8, '\xFF'),
                                                          std::string("\x7F\xFF\xFF\xFF", 4)};
        const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
        const std::string& extreme = kExtremes[below(kExtremes.size())];
        std::size_t end = at;
        while (end < bytes.size() && is_digit(bytes[end])) ++end;
        bytes.replace(at, end > at ? end - at : std::min(extreme.size(), bytes.size() - at), extreme);
    }

    void splice(std::string& bytes, std::size_t at) {
        const std::string& other = corpus()[below(corpus().size())];
        const std::size_t from = below(other.size());
        bytes = bytes.substr(0, at) + other.substr(from);
    }

    std::mt19937 random_;
};

TEST(FuzzCorpus, EveryFileIsReadOrRefusedByEveryReader) {
    ASSERT_GE(corpus().size(), readers().size());
    for (const std::string& bytes : corpus()) {
        for (const std::string_view reader : readers()) EXPECT_EQ(feed(reader, bytes), "") << reader << "\n" << bytes;
    }
}

TEST(FuzzCorpus, ChangedFilesAreReadOrRefused) {
    constexpr int kTrials = 400;
    Mutator mutator(20240611);
    for (const std::string& original : corpus()) {
        for (int trial = 0; trial < kTrials; ++trial) {
            const std::string changed = mutator.change(original);
            // An exact allocation, so that the address sanitizer sees any byte read behind the end.
            const std::vector<char> bytes(changed.begin(), changed.end());
            for (const std::string_view reader : readers()) {
                ASSERT_EQ(feed(reader, {bytes.data(), bytes.size()}), "") << reader << "\n" << changed;
            }
        }
    }
}

// A misspelt name must not pass for a reader that refuses everything.
TEST(FuzzCorpus, UnknownReaderIsAnError) { EXPECT_THROW(feed("nothing", "x"), std::out_of_range); }

}  // namespace
}  // namespace lumenline::fuzz
