// A surface that is exchanged for another one while it is read: what is handed on is one of the two as a whole, with
// the hash of its own bytes, or the file is refused.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <thread>

#include "engine/core/errors.h"
#include "io/mesh/mesh_io.h"
#include "io/mesh/sha256.h"

namespace lumenline {
namespace {

namespace fs = std::filesystem;

/// An OFF file whose points all have the x coordinate `digit`.
std::string surface_of(char digit) {
    constexpr int kPoints = 300000;
    std::string text = "OFF\n" + std::to_string(kPoints) + " 1 0\n";
    for (int i = 0; i < kPoints; ++i) text.append(1, digit).append(" 0 0\n");
    return text + "3 0 1 2\n";
}

/// Reads a file again and again while `exchange` puts one of two contents into it, until one reading is refused.
void expect_no_mixture(const std::function<void(const fs::path&, const std::string&)>& exchange) {
    const fs::path file = fs::path(::testing::TempDir()) / ("lumenline-change-" + std::to_string(::getpid()) + ".off");
    const std::string contents[] = {surface_of('1'), surface_of('2')};
    const std::map<std::string, double> x_of{{sha256_hex(contents[0]), 1}, {sha256_hex(contents[1]), 2}};
    exchange(file, contents[0]);
    std::atomic<bool> stop{false};
    std::thread writer([&] {
        for (int turn = 1; !stop; ++turn) {
            exchange(file, contents[turn % 2]);
            // Longer than a tick of the clock that stamps files.
            std::this_thread::sleep_for(std::chrono::milliseconds(12));
        }
    });
    bool refused = false;
    while (!refused && !::testing::Test::HasFailure()) {
        try {
            const TriangleSoup soup = read_surface(file.string());
            ASSERT_TRUE(x_of.contains(soup.source_sha256));
            for (const Vec3& p : soup.points) ASSERT_EQ(p.x, x_of.at(soup.source_sha256));
        } catch (const StageError& error) {
            EXPECT_EQ(error.code(), ErrorCode::kFileUnreadable) << error.what();
            refused = true;
            EXPECT_NE(std::string(error.what()).find("changed while it was read"), std::string::npos) << error.what();
        }
    }
    stop = true;
    writer.join();
    fs::remove(file);
}

TEST(ChangingSurface, WrittenInPlaceIsNeverAMixture) {
    expect_no_mixture([](const fs::path& file, const std::string& contents) {
        const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT, 0644);
        EXPECT_EQ(::pwrite(descriptor, contents.data(), contents.size(), 0), static_cast<ssize_t>(contents.size()));
        ::close(descriptor);
    });
}

TEST(ChangingSurface, ReplacedByARenameIsNeverAMixture) {
    expect_no_mixture([](const fs::path& file, const std::string& contents) {
        const fs::path other = file.string() + ".new";
        const int descriptor = ::open(other.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
        EXPECT_EQ(::write(descriptor, contents.data(), contents.size()), static_cast<ssize_t>(contents.size()));
        ::close(descriptor);
        fs::rename(other, file);
    });
}

}  // namespace
}  // namespace lumenline
