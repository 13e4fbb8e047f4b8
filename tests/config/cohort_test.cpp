// What a valid cohort file means: every key, every spelling of the models, and the way back to YAML.

#include "config/cohort.h"

#include "tests/config/support.h"

namespace lumenline {
namespace {

using testing::Folder;
using testing::model_with;
using testing::with;

using Covariates = std::vector<std::pair<std::string, std::string>>;

/// Everything of a task, for comparing two.
std::string task_text(const ModelTask& task) {
    const ModelIdentity& who = task.identity;
    std::string text = canonical_text(task) + task.surface_path;
    for (const std::string& part : {who.id, who.subject, who.session, who.side, who.structure, who.group,
                                    who.length_unit, who.coordinate_system, who.source_file})
        text += "|" + part;
    for (const auto& [name, value] : who.covariates) text.append("|").append(name).append("=").append(value);
    for (const auto& [branch, label] : who.branch_labels)
        text.append("|").append(std::to_string(branch)).append("=").append(label);
    return text;
}

void expect_same(const CohortConfig& a, const CohortConfig& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.run.threads, b.run.threads);
    EXPECT_EQ(a.run.models_in_flight, b.run.models_in_flight);
    EXPECT_EQ(a.run.memory_percent, b.run.memory_percent);
    EXPECT_EQ(a.run.memory_bytes, b.run.memory_bytes);
    EXPECT_EQ(a.run.model_timeout, b.run.model_timeout);
    EXPECT_EQ(a.run.model_memory, b.run.model_memory);
    EXPECT_EQ(a.run.isolation, b.run.isolation);
    EXPECT_EQ(a.archive.directory, b.archive.directory);
    EXPECT_EQ(a.archive.options.float32_fields, b.archive.options.float32_fields);
    EXPECT_EQ(a.labels.rule, b.labels.rule);
    EXPECT_EQ(a.labels.template_model, b.labels.template_model);
    EXPECT_EQ(a.labels.axes, b.labels.axes);
    ASSERT_EQ(a.tasks.size(), b.tasks.size());
    for (std::size_t i = 0; i < a.tasks.size(); ++i) EXPECT_EQ(task_text(a.tasks[i]), task_text(b.tasks[i]));
}

TEST(Cohort, MinimalFileHasTheDefaultsOfTheStructs) {
    const Folder folder;
    const std::string yaml = with("");
    const CohortConfig config = folder.load(yaml);
    EXPECT_EQ(config.name, "c");
    EXPECT_EQ(config.file, folder.path() / "cohort.yaml");
    EXPECT_EQ(config.text, yaml);
    EXPECT_EQ(config.run.threads, 0);
    EXPECT_EQ(config.run.models_in_flight, 0);
    EXPECT_EQ(config.archive.directory, folder.path() / "results");
    EXPECT_TRUE(config.archive.options.float32_fields);

    ModelTask expected;
    expected.identity.id = "a";
    expected.identity.source_file = "a.stl";
    expected.surface_path = (folder.path() / "a.stl").string();
    ASSERT_EQ(config.tasks.size(), 1U);
    EXPECT_EQ(task_text(config.tasks[0]), task_text(expected));
}

TEST(Cohort, EveryTopLevelKeyHasItsEffect) {
    const Folder folder;
    const CohortConfig config = folder.load(with(R"(length_unit: mm
coordinate_system: RAS
endpoints: {mode: points}
condition: {weld_tolerance: 1e-5, extension_radii: 0, check_self_intersections: false, drop_faces: false,
            orient_faces: false, split_non_manifold: false, fill_holes: false, repair_self_intersections: false,
            speck_share: 0, components: largest, refine_undersampled: false, decimate: 1e-3}
centerlines: {refine: none, pairs: all, join: centre, topology: network}
characterize: false
branches: {enabled: false, step: 0.5, smoothing: 1, section_step: 0.1, patches_along: 4, patches_around: 8}
run: {threads: 3, models_in_flight: 7, memory: 1.5 GB, model_timeout: 30min, model_memory: 250 MB,
      isolation: process}
archive: {directory: ../out, precision: float64})"));
    const ModelTask& task = config.tasks.at(0);
    EXPECT_EQ(task.identity.length_unit, "mm");
    EXPECT_EQ(task.identity.coordinate_system, "RAS");
    EXPECT_EQ(task.options.endpoints.mode, EndpointMode::kPoints);
    EXPECT_EQ(task.options.condition.weld_tolerance, 1e-5);
    EXPECT_EQ(task.options.condition.extension_radii, 0);
    const ConditionOptions& condition = task.options.condition;
    EXPECT_FALSE(condition.check_self_intersections || condition.drop_faces || condition.orient_faces);
    EXPECT_FALSE(condition.split_non_manifold || condition.fill_holes || condition.repair_self_intersections);
    EXPECT_FALSE(condition.refine_undersampled);
    EXPECT_EQ(condition.speck_share, 0);
    EXPECT_EQ(condition.components, ComponentPolicy::kLargest);
    EXPECT_EQ(condition.decimate, 1e-3);
    EXPECT_EQ(task.options.trace.refine, Refinement::kNone);
    EXPECT_EQ(task.options.trace.pairs, Pairs::kAll);
    EXPECT_EQ(task.options.trace.join, Join::kCentre);
    EXPECT_EQ(task.options.trace.topology, Topology::kNetwork);
    EXPECT_FALSE(task.options.characterize);
    EXPECT_FALSE(task.options.branches.enabled);
    EXPECT_EQ(task.options.branches.step, 0.5);
    EXPECT_EQ(task.options.branches.smoothing, 1);
    EXPECT_EQ(task.options.branches.section_step, 0.1);
    EXPECT_EQ(task.options.branches.patches_along, 4);
    EXPECT_EQ(task.options.branches.patches_around, 8);
    EXPECT_EQ(config.run.threads, 3);
    EXPECT_EQ(config.run.models_in_flight, 7);
    EXPECT_EQ(config.run.memory_bytes, 1.5e9);
    EXPECT_EQ(config.run.model_timeout, 1800);
    EXPECT_EQ(config.run.model_memory, 250e6);
    EXPECT_EQ(config.run.isolation, Isolation::kProcess);
    EXPECT_EQ(config.archive.directory, folder.path() / "../out");
    EXPECT_FALSE(config.archive.options.float32_fields);
}

TEST(Cohort, EveryChoiceOfAKeyIsUnderstood) {
    const Folder folder;
    auto mode = [&](const std::string& word) {
        return folder.load(with("endpoints: {mode: " + word + "}")).tasks.at(0).options.endpoints.mode;
    };
    EXPECT_EQ(mode("auto"), EndpointMode::kAuto);
    EXPECT_EQ(mode("boundaries"), EndpointMode::kBoundaries);
    EXPECT_EQ(mode("points"), EndpointMode::kPoints);
    EXPECT_EQ(mode("caps"), EndpointMode::kCaps);
    EXPECT_EQ(mode("[tips]"), EndpointMode::kTips);
    EXPECT_EQ(mode("[tips, boundaries]"), EndpointModes(EndpointMode::kBoundaries) | EndpointMode::kTips);
    for (const std::string system : {"LPS", "RAS", "unknown"})
        EXPECT_EQ(folder.load(with("coordinate_system: " + system)).tasks.at(0).identity.coordinate_system, system);
    EXPECT_EQ(folder.load(with("centerlines: {refine: path}")).tasks.at(0).options.trace.refine, Refinement::kPath);
    EXPECT_EQ(folder.load(with("centerlines: {pairs: nearest}")).tasks.at(0).options.trace.pairs, Pairs::kNearest);
    EXPECT_EQ(folder.load(with("centerlines: {topology: tree}")).tasks.at(0).options.trace.topology, Topology::kTree);
    for (const ArchiveFields fields : {ArchiveFields::kAll, ArchiveFields::kSurface, ArchiveFields::kLines})
        EXPECT_EQ(folder.load(with(std::string("archive: {fields: ").append(fields_name(fields)) + "}"))
                      .archive.options.fields,
                  fields);
    EXPECT_TRUE(folder.load(with("archive: {precision: float32}")).archive.options.float32_fields);
    EXPECT_EQ(folder.load(with("run: {threads: all, models_in_flight: auto}")).run.threads, 0);
    EXPECT_EQ(folder.load(with("run: {memory: 7%}")).run.memory_percent, 7);
    EXPECT_EQ(folder.load(with("run: {memory: 2TB}")).run.memory_bytes, 2e12);
    EXPECT_EQ(folder.load(with("run: {model_timeout: 90 s}")).run.model_timeout, 90);
    EXPECT_EQ(folder.load(with("run: {model_timeout: 2h}")).run.model_timeout, 7200);
    EXPECT_EQ(folder.load(with("run: {model_timeout: off}")).run.model_timeout, 0);
    EXPECT_EQ(folder.load(with("run: {model_memory: off}")).run.model_memory, 0);
    EXPECT_EQ(folder.load(with("run: {isolation: none}")).run.isolation, Isolation::kNone);
}

TEST(Cohort, InletsByRule) {
    const Folder folder;
    using Kind = InletRule::Kind;
    const auto rules = [](const CohortConfig& config) { return config.tasks.at(0).options.endpoints.inlet_rules; };
    const auto cohort_rules = [&](const std::string& text) {
        return rules(folder.load(with("endpoints:\n  inlet: " + text)));
    };
    EXPECT_TRUE(cohort_rules("largest").empty()) << "the default";
    EXPECT_EQ(cohort_rules("highest z; smallest"),
              (std::vector<InletRule>{{Kind::kHighest, 2, 1, {}}, {Kind::kSmallest, 2, 1, {}}}));
    EXPECT_EQ(cohort_rules("lowest x"), (std::vector<InletRule>{{Kind::kLowest, 0, 1, {}}}));
    EXPECT_EQ(cohort_rules("nearest [1, -2e1, 3]"), (std::vector<InletRule>{{Kind::kNearest, 2, 1, {1, -20, 3}}}));
    EXPECT_EQ(cohort_rules("point [1,2,3]"), (std::vector<InletRule>{{Kind::kPoint, 2, 1, {1, 2, 3}}}));
    EXPECT_EQ(cohort_rules("boundary 2"), (std::vector<InletRule>{{Kind::kBoundary, 2, 2, {}}}));
    EXPECT_EQ(rules(folder.load(model_with("inlets: highest y"))),
              (std::vector<InletRule>{{Kind::kHighest, 1, 1, {}}}));
    const CohortConfig own = folder.load(
        "cohort: c\nendpoints: {inlet: smallest}\nmodels:\n  - {id: a, surface: a.stl}\n"
        "  - {id: b, surface: b.stl, inlets: [[1, 2, 3]]}\n  - {id: c, surface: c.stl, inlets: lowest z}\n");
    EXPECT_EQ(own.tasks.at(0).options.endpoints.inlet_rules.at(0).kind, Kind::kSmallest);
    EXPECT_TRUE(own.tasks.at(1).options.endpoints.inlet_rules.empty());
    EXPECT_EQ(own.tasks.at(2).options.endpoints.inlet_rules.at(0).kind, Kind::kLowest);
    folder.write("again.yaml", resolved_text(own));
    const CohortConfig again = load_cohort(folder.path() / "again.yaml");
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(canonical_text(again.tasks.at(i)), canonical_text(own.tasks.at(i)));
    const CohortConfig two = folder.load(with("endpoints: {mode: [tips, caps]}"));
    folder.write("two.yaml", resolved_text(two));
    EXPECT_EQ(canonical_text(load_cohort(folder.path() / "two.yaml").tasks.at(0)), canonical_text(two.tasks.at(0)));
    EXPECT_EQ(folder.load(with("endpoints: {tip_length: 4.5}")).tasks.at(0).options.endpoints.tip_length, 4.5);
}

TEST(Cohort, EveryModelKeyHasItsEffect) {
    const Folder folder;
    const CohortConfig config = folder.load(model_with(R"(subject: P01
    session: baseline
    side: left
    structure: portal vein
    group: control
    inlets: [[0, 0, 12.5], [1e1, -.5, +3.]]
    outlets: [[1, 2, 3]]
    scale: 0.1
    covariates: {age: 063, "sex": F, note: "a: b", weight: })"));
    const ModelTask& task = config.tasks.at(0);
    EXPECT_EQ(task.identity.subject, "P01");
    EXPECT_EQ(task.identity.session, "baseline");
    EXPECT_EQ(task.identity.side, "left");
    EXPECT_EQ(task.identity.structure, "portal vein");
    EXPECT_EQ(task.identity.group, "control");
    EXPECT_EQ(task.scale, 0.1);
    EXPECT_EQ(task.options.endpoints.inlets, (std::vector<Vec3>{{0, 0, 12.5}, {10, -0.5, 3}}));
    EXPECT_EQ(task.options.endpoints.outlets, (std::vector<Vec3>{{1, 2, 3}}));
    const Covariates expected{{"age", "063"}, {"sex", "F"}, {"note", "a: b"}, {"weight", "n/a"}};
    EXPECT_EQ(task.identity.covariates, expected);
}

TEST(Cohort, TextsAreKeptAsWritten) {
    const Folder folder;
    const CohortConfig config =
        folder.load("cohort: Ärzte ≥ 2\nmodels:\n  - {id: 007, surface: a.stl, side: no, group: 1e3, subject: ''}\n");
    EXPECT_EQ(config.name, "Ärzte ≥ 2");
    EXPECT_EQ(config.tasks.at(0).identity.id, "007");
    EXPECT_EQ(config.tasks.at(0).identity.side, "no");
    EXPECT_EQ(config.tasks.at(0).identity.group, "1e3");
    EXPECT_EQ(config.tasks.at(0).identity.subject, "");
}

TEST(Cohort, ListMayStandUnderItsKeyOrDirectlyUnderModels) {
    const Folder folder;
    const CohortConfig direct = folder.load(with(""));
    const CohortConfig keyed = folder.load("cohort: c\nmodels:\n  list: [{id: a, surface: a.stl}]\n");
    expect_same(direct, keyed);
}

TEST(Cohort, ModelsWithoutACovariateOfOthersHaveItMissing) {
    const Folder folder;
    const CohortConfig config = folder.load(
        "cohort: c\nmodels:\n  - {id: a, surface: a.stl, covariates: {age: 1}}\n"
        "  - {id: b, surface: b.stl, covariates: {sex: F, age: 2}}\n  - {id: d, surface: d.stl}\n");
    EXPECT_EQ(config.tasks.at(0).identity.covariates, (Covariates{{"age", "1"}, {"sex", "n/a"}}));
    EXPECT_EQ(config.tasks.at(1).identity.covariates, (Covariates{{"age", "2"}, {"sex", "F"}}));
    EXPECT_EQ(config.tasks.at(2).identity.covariates, (Covariates{{"age", "n/a"}, {"sex", "n/a"}}));
}

TEST(Cohort, AliasesShareAValue) {
    const Folder folder;
    const CohortConfig config = folder.load(
        "cohort: c\nmodels:\n  - {id: a, surface: a.stl, inlets: &roots [[1, 2, 3]]}\n"
        "  - {id: b, surface: b.stl, inlets: *roots}\n");
    EXPECT_EQ(config.tasks.at(1).options.endpoints.inlets, (std::vector<Vec3>{{1, 2, 3}}));
}

TEST(Cohort, AbsolutePathsStayAsTheyAre) {
    const Folder folder;
    const CohortConfig config =
        folder.load("cohort: c\nmodels: [{id: a, surface: /data/a.stl}]\narchive: {directory: /data/out}\n");
    EXPECT_EQ(config.tasks.at(0).surface_path, "/data/a.stl");
    EXPECT_EQ(config.tasks.at(0).identity.source_file, "/data/a.stl");
    EXPECT_EQ(config.archive.directory, "/data/out");
}

TEST(Cohort, WindowsLineEndsAndByteOrderMarkChangeNothing) {
    const Folder folder;
    const std::string plain = model_with("covariates: {age: 3}");
    std::string windows = "\xEF\xBB\xBF";
    for (const char c : plain) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    const CohortConfig expected = folder.load(plain);
    const CohortConfig config = folder.load(windows);
    EXPECT_EQ(config.text, windows);
    expect_same(config, expected);
}

TEST(Cohort, GlobTakesStemsInTheOrderOfPaths) {
    const Folder folder;
    for (const std::string name : {"b2.stl", "B1.ply", "a.x.stl", ".hidden.stl", "notes.txt"})
        folder.write("surfaces/" + name, "");
    std::filesystem::create_directories(folder.path() / "surfaces/folder.stl");
    const CohortConfig config = folder.load("cohort: c\nmodels: {glob: 'surfaces/*.[sp][tl][ly]'}\n");
    ASSERT_EQ(config.tasks.size(), 3U);
    EXPECT_EQ(config.tasks[0].identity.id, "B1");
    EXPECT_EQ(config.tasks[1].identity.id, "a.x");
    EXPECT_EQ(config.tasks[2].identity.id, "b2");
    EXPECT_EQ(config.tasks[2].identity.source_file, "surfaces/b2.stl");
    EXPECT_EQ(config.tasks[2].surface_path, (folder.path() / "surfaces/b2.stl").string());
}

TEST(Cohort, GlobTakesTheFolderOfTheFileLiterally) {
    const Folder folder;
    folder.write("odd [1]*?/s/a.stl", "");
    const auto yaml = folder.write("odd [1]*?/cohort.yaml", "cohort: c\nmodels: {glob: s/*.stl}\n");
    const CohortConfig config = load_cohort(yaml);
    EXPECT_EQ(config.tasks.at(0).identity.source_file, "s/a.stl");
    EXPECT_EQ(config.tasks.at(0).surface_path, (folder.path() / "odd [1]*?/s/a.stl").string());
}

TEST(Cohort, RelativeFileWithoutFolderWorksInTheWorkingDirectory) {
    const Folder folder;
    folder.write("s/a.stl", "");
    folder.write("cohort.yaml", "cohort: c\nmodels: {glob: s/*.stl}\n");
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    const CohortConfig config = load_cohort("cohort.yaml");
    std::filesystem::current_path(before);
    EXPECT_EQ(config.tasks.at(0).surface_path, "s/a.stl");
    EXPECT_EQ(config.archive.directory, "results");
    EXPECT_NE(resolved_text(config).find("directory: \"results\""), std::string::npos);
}

TEST(ResolvedText, LoadsAgainToTheSameTasks) {
    const Folder folder;
    const CohortConfig config = folder.load(R"(cohort: "a # b: \"c\" ~"
length_unit: 'null'
coordinate_system: LPS
models:
  - {id: null-1, surface: "a b/ü.stl", subject: "~", side: "null", group: "1e3", inlets: [[0.1, -1e-300, 3]],
     outlets: [[1, 2, 3], [4, 5, 6.0000000000000009]], scale: 0.30000000000000004,
     covariates: {age: "007", "a: b": "- c", "~": ~, "[x]": "#", "é": "tab-less\\"}}
  - {id: 1e3, surface: /data/b.stl}
condition: {weld_tolerance: 0, check_self_intersections: false}
centerlines: {pairs: all}
run: {threads: 2}
archive: {directory: ../out, precision: float64}
)");
    const std::string text = resolved_text(config);
    const CohortConfig again = folder.load(text);
    expect_same(again, config);
    EXPECT_EQ(resolved_text(again), text);
    EXPECT_EQ(cohort_name(text), "a # b: \"c\" ~");
}

TEST(ResolvedText, NameOfWhatIsNoneIsAWord) {
    for (const char* text : {"", "models:\n", "cohort: [a, b]\n", "cohort: \"a\n"})
        EXPECT_EQ(cohort_name(text), "cohort");
    EXPECT_EQ(cohort_name("cohort: " + std::string(100'000, '[')), "cohort");
}

TEST(ResolvedText, ReplacesTableAndGlobByTheirModels) {
    const Folder folder;
    folder.write("s/a.stl", "");
    folder.write("t.tsv", "id\tsurface\tage\tinlets\na\ts/a.stl\t3\t1,2,3;4,5,6\nb\ts/b.stl\tn/a\t\n");
    for (const std::string models : {"{table: t.tsv}", "{glob: s/*.stl}"}) {
        const CohortConfig config = folder.load("cohort: c\nmodels: " + models + "\n");
        const std::string text = resolved_text(config);
        EXPECT_EQ(text.find("table"), std::string::npos);
        EXPECT_EQ(text.find("glob"), std::string::npos);
        expect_same(folder.load(text), config);
    }
}

TEST(ResolvedText, ArchiveDirectoryKeepsItsMeaning) {
    const Folder folder;
    for (const std::string directory : {"results", ".", "..", "../out", "a/../b", "/data/out", "./x"}) {
        const CohortConfig config = folder.load(with("archive: {directory: " + directory + "}"));
        EXPECT_EQ(folder.load(resolved_text(config)).archive.directory, config.archive.directory) << directory;
    }
}

}  // namespace
}  // namespace lumenline
