// The page of a cohort: what it says, that it needs nothing else, that text from the archive stays text, and that its
// pictures show the models.
#include "io/export/report.h"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "io/archive/read.h"
#include "io/export/raster.h"
#include "io/export/thumbnail.h"
#include "tests/cli/process.h"
#include "tests/damage/consumers.h"
#include "tests/damage/sample_cohort.h"

namespace lumenline::damage {
namespace {

namespace fs = std::filesystem;
using cli_test::read_text;
using cli_test::write_text;

std::string page_of(const fs::path& archive, std::vector<std::string> more = {}) {
    const fs::path file = archive.parent_path() / "report.html";
    std::vector<std::string> words{"report", archive.string(), "-o", file.string()};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run_command(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return read_text(file);
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != text.npos; ++at) ++found;
    return found;
}

/// An archive of a model that fails, with the columns that a table of models has.
fs::path cohort_of(const std::string& models, const std::string& name = "a") {
    const fs::path folder = cli_test::fresh_folder();
    write_text(folder / "broken.ply", "ply\n");
    write_text(folder / "models.tsv", models);
    write_text(folder / "cohort.yaml",
               "cohort: " + name + "\nmodels: {table: models.tsv}\narchive: {directory: results}\n");
    EXPECT_EQ(cli_test::run_lumenline({"run", "cohort.yaml"}, folder).status, 1);
    return folder / "results";
}

TEST(Report, SaysWhatWasDoneAndWhatCameOfIt) {
    const fs::path archive = sample_cohort();
    const std::string page = page_of(archive);
    for (const char* part :
         {"<title>a: report</title>", "<b>2</b><span>models</span>", "<b>1</b><span>failed</span>",
          "Geometry was computed with Lumenline", "1.2 of their radii", "Antiga L, Ene-Iordache B",
          "<code>condition.extension_radii</code></td><td><code>1.2</code>", "radius_min", "broken.ply",
          "1 of 2 models count; left out: 1 failed.", "<code>branches.smoothing</code>"})
        EXPECT_TRUE(has(page, part)) << part;
    EXPECT_EQ(count(page, "<img "), 1U) << "the model that failed has no surface";
    EXPECT_EQ(count(page, "<figure>"), count(page, "<svg "));
    EXPECT_GT(count(page, "<figure>"), 15U);
}

TEST(Report, NeedsNothingElseAndIsTheSameEachTime) {
    const fs::path archive = sample_cohort();
    const std::string page = page_of(archive);
    EXPECT_FALSE(has(page, "<script")) << "no scripts";
    EXPECT_FALSE(std::regex_search(page, std::regex("(src|href)=\"(?!data:|#)"))) << "nothing from outside";
    EXPECT_FALSE(has(page, "url(") || has(page, "@import"));
    EXPECT_TRUE(has(page, "default-src 'none'"));
    EXPECT_EQ(page_of(archive), page);
}

TEST(Report, RatingsComeBackAndLeaveOutWhatIsBad) {
    const fs::path archive = sample_cohort(), ratings = archive.parent_path() / "ratings.tsv";
    page_of(archive, {"--template", ratings.string()});
    EXPECT_EQ(read_text(ratings), "model\trating\tnote\nforked\t\t\nbroken\t\t\n");
    write_text(ratings, "model\trating\tnote\nforked\tbad\tleaks <here>\nbroken\t\t\n");
    const std::string page = page_of(archive, {"--ratings", ratings.string()});
    EXPECT_TRUE(has(page, "0 of 2 models count; left out: 1 rated bad, 1 failed.")) << page.substr(0, 6000);
    EXPECT_TRUE(has(page, "rated bad: leaks &lt;here&gt;"));
    EXPECT_TRUE(has(page, "<b>1</b><span>rated bad</span>"));
    const Outcome stats = run_command({"stats", archive.string(), "--ratings", ratings.string(), "--format", "json"});
    EXPECT_EQ(stats.status, 0) << stats.err;
    EXPECT_TRUE(has(stats.out, "1 rated bad")) << stats.out;
    const Outcome again =
        run_command({"report", archive.string(), "-o", (archive / "r.html").string(), "--template", ratings.string()});
    EXPECT_EQ(again.status, 2) << "ratings are not written over";
    EXPECT_TRUE(has(read_text(ratings), "leaks"));
    write_text(ratings, "id\trating\nforked\tgood\n");
    EXPECT_TRUE(has(page_of(archive, {"--ratings", ratings.string()}), "rated good")) << "'id' names models as well";
    write_text(ratings, "model\tnote\n");
    EXPECT_EQ(
        run_command({"report", archive.string(), "-o", (archive / "r.html").string(), "--ratings", ratings.string()})
            .status,
        2);
}

TEST(Report, RatingsStandInThePlaceOfCovariatesAndAreReadBack) {
    const fs::path archive =
        cohort_of("id\tsurface\trating\trating_note\nbroken\tbroken.ply\tfine\t\"\"\"hello\"\" world\"\n");
    const fs::path ratings = archive.parent_path() / "ratings.tsv";
    page_of(archive, {"--by", "id", "--template", ratings.string()});
    EXPECT_EQ(read_text(ratings), "model\trating\tnote\nbroken\tfine\t\"\"\"hello\"\" world\"\n");
    EXPECT_TRUE(has(page_of(archive, {"--by", "id", "--ratings", ratings.string()}), "&quot;hello&quot; world"));
    write_text(ratings, "model\trating\nbroken\tdoubtful\n");
    const std::string page = page_of(archive, {"--by", "id", "--ratings", ratings.string()});
    EXPECT_TRUE(has(page, "rated doubtful"));
    EXPECT_FALSE(has(page, "rated fine"));
}

TEST(Report, RatingsThatWouldBePassedOverAreSaid) {
    const fs::path archive = sample_cohort(), ratings = archive.parent_path() / "ratings.tsv";
    const auto rated = [&](const std::string& rows) {
        write_text(ratings, "model\trating\n" + rows);
        return run_command({"stats", archive.string(), "--ratings", ratings.string()});
    };
    for (const auto& [rows, sentence] : std::vector<std::pair<std::string, std::string>>{
             {"forked\tBad\n", ":2: column 'rating' holds 'Bad': write 'bad'"},
             {"forked\t\" bad\"\n", ":2: column 'rating' holds ' bad': write 'bad'"},
             {"forked\tbad\nforked\tgood\n", ":3: model 'forked' has a rating in line 2 already"}}) {
        const Outcome outcome = rated(rows);
        EXPECT_EQ(outcome.status, 2) << rows;
        EXPECT_TRUE(has(outcome.err, sentence)) << outcome.err;
    }
    const Outcome unknown = rated("forkd\tbad\nforked\tgood\nb\tbad\n");
    EXPECT_EQ(unknown.status, 0) << unknown.err;
    EXPECT_TRUE(has(unknown.err, "2 ratings in")) << unknown.err;
    EXPECT_TRUE(has(unknown.err, "the first of 'forkd' in line 2\n")) << unknown.err;
    EXPECT_EQ(count(unknown.err, "\n"), 1U) << unknown.err;
}

TEST(Report, CountsModelsWhoseFilesCannotBeRead) {
    const fs::path archive = sample_cohort(), file = archive.parent_path() / "report.html";
    write_text(whole_model(archive), "no model");
    const Outcome outcome = run_command({"report", archive.string(), "-o", file.string()});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_TRUE(has(outcome.err, "the files of 1 model could not be read")) << outcome.err;
    EXPECT_EQ(count(outcome.err, "\n"), 1U) << outcome.err;
    EXPECT_TRUE(has(read_text(file), "<b>1</b><span>could not be read</span>"));
}

TEST(Report, TitleIsTheNameAsItWasGiven) {
    const fs::path archive = cohort_of("id\tsurface\nbroken\tbroken.ply\n", "'the \"left\" \\ side'");
    EXPECT_TRUE(has(page_of(archive, {"--by", "id"}), "<title>the &quot;left&quot; \\ side: report</title>"));
}

TEST(Report, TextOfTheArchiveStaysText) {
    const fs::path archive = sample_cohort();
    for (const fs::path& file : {archive / "cohort.h5", whole_model(archive)}) {
        std::string bytes = read_text(file);
        // Of the same length, so that nothing but the text changes: the failure's sentence and the options.
        const auto replace = [&](const std::string& from, const std::string& to) {
            ASSERT_EQ(from.size(), to.size());
            for (std::size_t at = 0; (at = bytes.find(from, at)) != bytes.npos;) bytes.replace(at, from.size(), to);
        };
        replace("broken.ply", "<img src=>");
        replace("condition.speck_share", "<script>alert(1)//xxx");
        write_text(file, bytes);
    }
    const std::string page = page_of(archive);
    EXPECT_FALSE(has(page, "<img src=>"));
    EXPECT_FALSE(has(page, "<script"));
    EXPECT_TRUE(has(page, "&lt;img src=&gt;"));
    EXPECT_TRUE(has(page, "&lt;script&gt;alert(1)//xxx"));
}

TEST(Report, WrongRequestsAreRefusedInOneSentence) {
    const fs::path archive = sample_cohort();
    const std::string out = (archive.parent_path() / "r.html").string();
    for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{
             {"--by", "grup"}, {"--measure", "status"}, {"--measure", "radius"}, {"--ratings", "nowhere.tsv"}}) {
        std::vector<std::string> words{"report", archive.string(), "-o", out};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome outcome = run_command(words);
        EXPECT_EQ(outcome.status, 2) << more[1];
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
    EXPECT_EQ(run_command({"report", whole_model(archive).string(), "-o", out}).status, 2) << "one model is no cohort";
    EXPECT_EQ(run_command({"report", archive.string(), "-o", "/nowhere/r.html"}).status, 1);
    EXPECT_FALSE(fs::exists(out));
}

TEST(Report, OutliersAreThoseFarFromTheMedian) {
    Report report;
    report.title = "t";
    report.models.resize(3);
    report.models[2].id = "far";
    report.measures = {{"m", "mm", "", {{"g", {{1, 0, false}, {2, 1, false}, {50, 2, true}}, 1.5, 2, 26}}}};
    report.outliers = {{2, "m", "mm", 50, 2, 32.4}};
    std::ostringstream page;
    write_report(report, page);
    EXPECT_TRUE(has(page.str(), "<a href=\"#m2\">far</a>"));
    EXPECT_TRUE(has(page.str(), "+32.4"));
    EXPECT_TRUE(has(page.str(), "<title>far: 50</title>")) << "its point is a link with its name";
}

TEST(Thumbnail, ShowsTheModelOnTransparentGround) {
    const Thumbnail drawn = draw_model(ArchiveFile(whole_model(sample_cohort())), 80);
    ASSERT_EQ(drawn.picture.pixels.size(), 80U * 80U);
    EXPECT_GT(drawn.largest, 0);
    EXPECT_LE(drawn.picture.palette.size(), 256U);
    std::vector<std::size_t> uses(256, 0);
    for (const std::uint8_t p : drawn.picture.pixels) {
        ASSERT_LT(p, drawn.picture.palette.size());
        ++uses[p];
    }
    EXPECT_EQ(drawn.picture.palette[0][3], 0) << "the ground";
    EXPECT_GT(uses[0], 1000U);
    EXPECT_GT(uses[1], 40U) << "the lines";
    const auto colours = std::count_if(uses.begin(), uses.end(), [](std::size_t n) { return n > 0; });
    EXPECT_GT(colours, 20) << "shades and hues";
    EXPECT_EQ(drawn.picture.pixels.front(), 0) << "nothing is drawn in the margin";
}

TEST(Thumbnail, PngHoldsThePicture) {
    const Picture picture{2, 2, {0, 1, 2, 1}, {{0, 0, 0, 0}, {255, 0, 0, 255}, {0, 0, 255, 128}}};
    const std::string file = png_of(picture);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_memory(&image, file.data(), file.size()), 0);
    image.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
    ASSERT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
    EXPECT_EQ(pixels, (std::vector<std::uint8_t>{0, 0, 0, 0, 255, 0, 0, 255, 0, 0, 255, 128, 255, 0, 0, 255}));
}

TEST(Canvas, NearestTriangleIsSeenAndBadOnesAreNot) {
    const auto triangle = [](double z, double hue) {
        return std::array<Corner, 3>{{{{0, 0, z}, hue, 1}, {{8, 0, z}, hue, 1}, {{0, 8, z}, hue, 1}}};
    };
    Canvas canvas(8);
    canvas.draw(triangle(1, 0.25));
    canvas.draw(triangle(2, 0.75));
    canvas.draw(triangle(0, 0.5));
    EXPECT_FLOAT_EQ(canvas.at(1, 1).hue, 0.75F);
    EXPECT_FALSE(canvas.at(7, 7).covered);
    std::size_t cells = 0;
    for (std::size_t y = 0; y < 8; ++y)
        for (std::size_t x = 0; x < 8; ++x) cells += canvas.at(x, y).covered ? 1 : 0;
    EXPECT_EQ(cells, 36U) << "centres in the lower half of a square of eight, the diagonal's too";
    Canvas other(8);
    auto bad = triangle(1, 0.5);
    bad[1].place.x = NAN;
    other.draw(bad);
    bad[1].place = {1e300, -1e300, 0};
    bad[2].place = {-1e300, 1e300, 0};
    other.draw(bad);  // a triangle of no end must not be drawn cell by cell beyond the canvas
    other.stroke({NAN, 0, 0}, {1, 1, 0}, 1);
    EXPECT_FALSE(other.at(7, 0).line);
    other.stroke({0, 4, 0}, {8, 4, 0}, 0.6);
    EXPECT_TRUE(other.at(3, 4).line && other.at(3, 3).line);
    EXPECT_FALSE(other.at(3, 6).line);
}

}  // namespace
}  // namespace lumenline::damage
