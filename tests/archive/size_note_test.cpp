// A model whose size is far from the others' of its cohort has probably another unit.

#include "engine/core/size_note.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lumenline {
namespace {

using Sizes = std::vector<double>;

TEST(SizeNote, IsSilentWithinTheSpreadOfAnatomy) {
    for (const std::string& note : size_notes(Sizes{50, 80, 100, 140, 250}, "mm")) EXPECT_EQ(note, "");
}

TEST(SizeNote, NamesTheFactorNearestToTheRatio) {
    const struct {
        double size;
        const char* words;
    } cases[] = {{1050, "scale: 0.1`"},  {2540, "scale: 0.0393701`"}, {120000, "scale: 0.001`"}, {9, "scale: 10`"},
                 {0.11, "scale: 1000`"}, {3.9, "scale: 25.4`"},       {10400, "scale: 0.01`"}};
    for (const auto& c : cases) {
        const auto notes = size_notes(Sizes{90, 100, c.size, 110, 100}, "unknown");
        EXPECT_NE(notes[2].find(c.words), std::string::npos) << c.size << ": " << notes[2];
        for (const std::size_t other : {0U, 1U, 3U, 4U}) EXPECT_EQ(notes[other], "");
    }
}

TEST(SizeNote, SaysWhatTheOtherUnitMayBe) {
    EXPECT_NE(size_notes(Sizes{10, 10, 10, 100}, "cm")[3].find("mm where the others are in cm"), std::string::npos);
    EXPECT_NE(size_notes(Sizes{10, 10, 10, 0.01}, "mm")[3].find("m where the others are in mm"), std::string::npos);
    EXPECT_NE(size_notes(Sizes{10, 10, 10, 100}, "unknown")[3].find("mm beside cm"), std::string::npos);
}

TEST(SizeNote, DoesNotDependOnTheUnitOfAll) {
    const Sizes sizes{90, 100, 1000, 110, 4};
    const auto notes = size_notes(sizes, "unknown");
    for (const double scale : {1e-6, 1e-3, 1e3}) {
        Sizes scaled;
        for (const double s : sizes) scaled.push_back(scale * s);
        const auto other = size_notes(scaled, "unknown");
        for (std::size_t i = 0; i < sizes.size(); ++i) EXPECT_EQ(other[i].empty(), notes[i].empty());
    }
}

TEST(SizeNote, HasNoGuessForAnOddRatioOrTooFewSizes) {
    EXPECT_NE(size_notes(Sizes{10, 10, 10, 1e9}, "mm")[3].find("no change of unit"), std::string::npos);
    EXPECT_EQ(size_notes(Sizes{10, 1000}, "mm")[1], "");
    EXPECT_TRUE(size_notes(Sizes{}, "mm").empty());
    const double kNaN = std::numeric_limits<double>::quiet_NaN();
    const auto notes = size_notes(Sizes{kNaN, 0, 10, 11, 12, 120}, "mm");
    EXPECT_EQ(notes[0] + notes[1] + notes[2], "");
    EXPECT_NE(notes[5], "");
}

}  // namespace
}  // namespace lumenline
