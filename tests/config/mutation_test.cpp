// Random damage to valid files: whatever the bytes, the loader loads or throws ConfigError.

#include <algorithm>
#include <cstdint>
#include <random>
#include <string_view>

#include "tests/config/support.h"

namespace lumenline {
namespace {

using testing::Folder;

constexpr std::string_view kYaml = R"(cohort: "c \u00e9" # name
length_unit: mm
coordinate_system: LPS
models:
  list:
    - &first {id: a, surface: s/a.stl, inlets: &p [[0, 0, 1.5e1]], scale: 0.1}
    - id: b
      surface: 's/b.stl'
      outlets: *p
      covariates: {age: 63, "sex": F}
    - id: |-
        c
      surface: >-
        s/c.stl
endpoints: {mode: auto}
condition:
  weld_tolerance: 1e-7
  check_self_intersections: true
run: {threads: all, models_in_flight: 4}
archive: {directory: results}
)";

constexpr std::string_view kTable =
    "id\tsurface\tinlet\tscale\tnote\na\ta.stl\t1,2,3;4,5,6\t0.5\t\"x \"\"y\"\"\"\nb\tb.stl\tn/a\t\té\n";

/// One to four random edits: a byte replaced, inserted or removed, or a stretch copied elsewhere.
std::string damaged(std::string_view original, std::mt19937& random) {
    static constexpr std::string_view kTelling = "\n\r\t :-?[]{},&*!|>'\"%@`#<~.0129aeE\\/;\x04\xFF\xC3";
    std::string text(original);
    const std::size_t edits = 1 + random() % 4;
    for (std::size_t i = 0; i < edits && !text.empty(); ++i) {
        const std::size_t at = random() % text.size();
        const char byte = random() % 4 == 0 ? static_cast<char>(random() % 256) : kTelling[random() % kTelling.size()];
        switch (random() % 4) {
            case 0: text[at] = byte; break;
            case 1: text.insert(at, 1, byte); break;
            case 2: text.erase(at, 1 + random() % 8); break;
            default: text.insert(at, text.substr(random() % text.size(), random() % 24)); break;
        }
    }
    return text;
}

/// Loads damaged copies; returns how many still loaded and checks that these survive resolved_text.
int count_loaded(const Folder& folder, std::string_view original, const std::string& name, int rounds) {
    std::mt19937 random(20240517);  // fixed: a failure is the same failure again
    int loaded = 0;
    for (int i = 0; i < rounds; ++i) {
        const std::string text = damaged(original, random);
        folder.write(name, text);
        try {
            const CohortConfig config = load_cohort(folder.path() / "cohort.yaml");
            ++loaded;
            const std::string resolved = resolved_text(config);
            folder.write("resolved.yaml", resolved);
            EXPECT_EQ(resolved_text(load_cohort(folder.path() / "resolved.yaml")), resolved) << text;
        } catch (const ConfigError& e) {
            EXPECT_EQ(std::string_view(e.what()).find('\n'), std::string_view::npos) << text;
            EXPECT_LE(e.line(),
                      static_cast<std::size_t>(std::ranges::count(text, '\n') + std::ranges::count(text, '\r') + 1))
                << e.what() << "\n"
                << text;
        }
    }
    return loaded;
}

TEST(Mutations, OfAYamlFileOnlyThrowConfigError) {
    const Folder folder;
    constexpr int kRounds = 6000;
    const int loaded = count_loaded(folder, kYaml, "cohort.yaml", kRounds);
    // Both outcomes must be common, or the test would prove nothing.
    EXPECT_GT(loaded, kRounds / 50);
    EXPECT_LT(loaded, kRounds / 2);
}

TEST(Mutations, OfATableOnlyThrowConfigError) {
    const Folder folder;
    folder.write("cohort.yaml", "cohort: c\nmodels: {table: t.tsv}\n");
    constexpr int kRounds = 3000;
    const int loaded = count_loaded(folder, kTable, "t.tsv", kRounds);
    EXPECT_GT(loaded, kRounds / 50);
    EXPECT_LT(loaded, kRounds / 2);
}

}  // namespace
}  // namespace lumenline
