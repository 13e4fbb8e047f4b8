#include "tests/mesh/refusal.h"

#include <gtest/gtest.h>

#include "io/mesh/formats.h"
#include "tests/mesh/samples.h"

namespace lumenline::samples {

void expect_refused(const Refusal& refusal) {
    try {
        mesh::parse_surface({refusal.name, refusal.bytes});
        ADD_FAILURE() << "accepted: " << refusal.bytes;
    } catch (const StageError& error) {
        const std::string sentence = error.what();
        EXPECT_EQ(error.code(), refusal.code) << sentence;
        EXPECT_TRUE(sentence.starts_with(refusal.name)) << sentence;
        EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
        for (const std::string& part : refusal.parts) {
            EXPECT_NE(sentence.find(part), std::string::npos) << sentence << "\nlacks: " << part;
        }
    }
}

std::string replaced(std::string bytes, const std::string& from, const std::string& to) {
    const std::size_t at = bytes.find(from);
    EXPECT_NE(at, std::string::npos) << "the bytes lack " << from;
    return at == std::string::npos ? bytes : bytes.replace(at, from.size(), to);
}

std::string changed(const std::string& sample, const std::string& from, const std::string& to) {
    return replaced(named(sample).bytes, from, to);
}

}  // namespace lumenline::samples
