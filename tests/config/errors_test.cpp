// Every way to be wrong, with the line and the sentence the user reads.

#include <vector>

#include "tests/config/support.h"

namespace lumenline {
namespace {

using testing::Folder;
using testing::model_with;
using testing::with;

/// YAML, its error's line, and a part of the sentence.
struct Case {
    std::string yaml;
    int line;
    std::string part;
};

void expect_errors(const std::vector<Case>& cases) {
    const Folder folder;
    for (const Case& c : cases) {
        const std::string error = folder.error(c.yaml);
        const std::string start = "cohort.yaml:" + std::to_string(c.line) + ": ";
        EXPECT_TRUE(error.starts_with(start)) << c.yaml << "\n  gives " << error << "\n  not line " << c.line;
        EXPECT_NE(error.find(c.part), std::string::npos) << c.yaml << "\n  gives " << error << "\n  without " << c.part;
    }
}

TEST(ConfigErrors, WholeSentencesReadWell) {
    const Folder folder;
    EXPECT_EQ(folder.error("cohort: c\nmodels: []\nrun:\n  treads: 3\n"),
              "cohort.yaml:4: unknown key 'treads' in 'run'; did you mean 'threads'?");
    EXPECT_EQ(folder.error(model_with("scale: 0")), "cohort.yaml:5: key 'scale' must be greater than 0, not '0'");
    EXPECT_EQ(folder.error(model_with("scale: 010")),
              "cohort.yaml:5: key 'scale' must be a decimal number such as 12.5 or 1e-7, not '010'");
    EXPECT_EQ(folder.error(with("endpoints: {mode: point}")),
              "cohort.yaml:2: key 'mode' must be auto, boundaries, caps, tips or points, not 'point'; did you mean "
              "'points'?");
}

TEST(ConfigErrors, UnknownKeysGetTheNearestOne) {
    expect_errors({
        {with("lenght_unit: mm"), 2, "unknown key 'lenght_unit' in the configuration; did you mean 'length_unit'?"},
        {with("endpoints: {mode: [tips, tips]}"), 2, "lists 'tips' twice"},
        {with("endpoints: {mode: []}"), 2, "must list at least one of"},
        {with("endpoints: {inlet: larges}"), 2, "did you mean 'largest'?"},
        {with("endpoints: {inlet: highest w}"), 2, "takes an axis x, y or z, not 'w'"},
        {with("endpoints: {inlet: largest z}"), 2, "takes nothing behind it"},
        {with("endpoints: {inlet: boundary 0}"), 2, "must lie between 1 and"},
        {with("endpoints:\n  inlet: nearest 1,2,3"), 3, "takes a point [x, y, z]"},
        {with("endpoints: {inlet: 1}"), 2, "must say largest,"},
        {with("endpoints: {tip_length: 0.5}"), 2, "must lie between 1 and 1000"},
        {model_with("inlets: higest z"), 5, "did you mean 'highest'?"},
        {with("endpoint: {mode: auto}"), 2, "did you mean 'endpoints'?"},
        {with("Archive: {}"), 2, "did you mean 'archive'?"},
        {with("run:\n  thread: 3"), 3, "did you mean 'threads'?"},
        {with("condition: {extention_radii: 1}"), 2, "did you mean 'extension_radii'?"},
        {with("centerlines: {refien: path}"), 2, "did you mean 'refine'?"},
        {model_with("sesion: x"), 5, "unknown key 'sesion' in model 1 of the list; did you mean 'session'?"},
        {model_with("inlet: [[0,0,0]]"), 5, "did you mean 'inlets'?"},
        {with("threads: 3"), 2, "it belongs below 'run'"},
        {with("subject: x"), 2, "it belongs below 'models.list[]'"},
        {with("archive: {zzzz: 1}"), 2, "valid keys are directory, fields or precision"},
        {with("endpoints: {mode:auto}"), 2, "write a blank after the ':'"},
        {"cohort: c\nmodels: {tables: x.tsv}\n", 2, "did you mean 'table'?"},
    });
}

TEST(ConfigErrors, DuplicateKeysNameBothLines) {
    expect_errors({
        {with("cohort: d"), 2, "the key 'cohort' appears twice; the first is in line 1"},
        {with("run:\n  threads: 2\n  threads: 3"), 4, "the first is in line 3"},
        {model_with("surface: b.stl"), 5, "the key 'surface' appears twice; the first is in line 4"},
        {model_with("covariates:\n      age: 1\n      age: 2"), 7, "the key 'age' appears twice"},
        {model_with("covariates: {age: 1, \"age\": 2}"), 5, "the key 'age' appears twice"},
    });
}

TEST(ConfigErrors, MissingAndEmptyKeys) {
    expect_errors({
        {"models:\n  - {id: a, surface: a.stl}\n", 1, "key 'cohort' is missing"},
        {"cohort: c\n", 1, "key 'models' is missing"},
        {"cohort: c\nmodels:\n  - surface: a.stl\n", 3, "key 'id' is missing"},
        {"cohort: c\nmodels:\n  - id: a\n", 3, "key 'surface' is missing"},
        {"cohort:\nmodels:\n  - {id: a, surface: a.stl}\n", 1, "key 'cohort' has no value"},
        {"cohort: ~\nmodels:\n  - {id: a, surface: a.stl}\n", 1, "key 'cohort' has no value"},
        {"cohort: ' '\nmodels:\n  - {id: a, surface: a.stl}\n", 1, "key 'cohort' must not be empty"},
        {with("run:"), 2, "key 'run' has no value"},
        {with("run:\n  threads:\n"), 3, "key 'threads' has no value"},
        {with("length_unit: ''"), 2, "must not be empty"},
        {with("archive: {directory: ''}"), 2, "must not be empty"},
        {"", 1, "the file is empty"},
        {"# nothing\n", 1, "the file is empty"},
        {"cohort: c\nmodels:\n", 2, "key 'models' has no value"},
        {"cohort: c\nmodels: []\n", 2, "holds no model"},
        {"cohort: c\nmodels: {}\n", 2, "must hold exactly one of list, table and glob, but is empty"},
        {"cohort: c\nmodels: {list: []}\n", 2, "holds no model"},
        {"cohort: c\nmodels:\n  list: [{id: a, surface: a}]\n  glob: '*'\n", 4, "but has both 'list' and 'glob'"},
    });
}

TEST(ConfigErrors, WrongTypes) {
    expect_errors({
        {"just text\n", 1, "the configuration must be a map of keys, not text"},
        {"- a\n", 1, "the configuration must be a map of keys, not a list"},
        {with("run: fast"), 2, "'run' must be a map of keys, not text"},
        {with("run: [1]"), 2, "'run' must be a map of keys, not a list"},
        {"cohort: [c]\nmodels: []\n", 1, "key 'cohort' must be text, not a list"},
        {"cohort: c\nmodels: all\n", 2, "must be a list of models or a map"},
        {"cohort: c\nmodels:\n  list:\n    id: a\n", 4, "must be a list of models, not a map"},
        {"cohort: c\nmodels:\n  - a.stl\n", 3, "model 1 of the list must be a map of keys, not text"},
        {"cohort: c\nmodels: {table: [a]}\n", 2, "must be text, not a list"},
        {with("endpoints: {mode: {tips: 1}}"), 2, "must be auto, boundaries, caps, tips or points, not a map"},
        {with("endpoints: {mode: [[auto]]}"), 2, "must list auto, boundaries, caps, tips or points, not a list"},
        {with("condition: {check_self_intersections: yes}"), 2, "must be true or false, not 'yes'"},
        {with("condition: {check_self_intersections: \"true\"}"), 2, "must be true or false without quotes"},
        {with("condition: {extension_radii: '1'}"), 2, "must be a number without quotes, not the text '1'"},
        {with("condition: {extension_radii: [1]}"), 2, "must be a number, not a list"},
        {with("run: {threads: '4'}"), 2, "must be a whole number without quotes"},
        {model_with("inlets: 1,2,3"), 5, "must be a list of points [[x, y, z], ...], not text"},
        {model_with("inlets: [1, 2, 3]"), 5, "must be a list of points [[x, y, z], ...], not a list of '1'"},
        {model_with("inlets: [[1, 2]]"), 5, "but point 1 has 2 coordinates"},
        {model_with("inlets:\n      - [1, 2, 3]\n      - [1, 2, 3, 4]"), 7, "but point 2 has 4 coordinates"},
        {model_with("outlets: [[1, 2, a]]"), 5, "must be a decimal number such as 12.5 or 1e-7, not 'a'"},
        {model_with("outlets: [[1, 2, '3']]"), 5, "a coordinate of point 1 is in quotes"},
        {model_with("outlets: [[1, 2, ~]]"), 5, "a coordinate of point 1 is nothing"},
        {model_with("covariates: [age]"), 5, "must be a map of names and values, not a list"},
        {model_with("covariates: {age: [1]}"), 5, "key 'age' must be one value, not a list"},
        {model_with("subject: {a: b}"), 5, "must be text, not a map"},
        {model_with("subject: \"a\\nb\""), 5, "must be one line without control characters: 'a b'"},
        {"cohort: |\n  a\n  b\nmodels: []\n", 1, "must be one line"},
    });
}

TEST(ConfigErrors, NumbersArePlainDecimalsWithinLimits) {
    for (const std::string number :
         {"010", "0x10", "0o7", ".inf", "-.inf", ".nan", "inf",   "nan",    "1_000", "1,5",
          "1e",  "e3",   "+",   ".",    "1.5mm", "--1",  "1e999", "1e-999", "00",    "true"}) {
        const Folder folder;
        for (const std::string& yaml : {model_with("scale: " + number), model_with("inlets: [[0, 0, '" + number)})
            EXPECT_TRUE(folder.error(yaml).starts_with("cohort.yaml:")) << yaml;
        EXPECT_NE(folder.error(model_with("scale: " + number)).find("5: key 'scale' "), std::string::npos) << number;
    }
    expect_errors({
        {model_with("scale: -1"), 5, "must be greater than 0, not '-1'"},
        {model_with("scale: 0"), 5, "must be greater than 0"},
        {model_with("scale: 1e999"), 5, "is beyond the range of a number in double precision"},
        {with("condition: {weld_tolerance: -1e-9}"), 2, "must lie between 0 and 0.01, not '-1e-9'"},
        {with("condition: {weld_tolerance: 0.5}"), 2, "must lie between 0 and 0.01"},
        {with("condition: {extension_radii: -1}"), 2, "must lie between 0 and 100"},
        {with("condition: {extension_radii: 101}"), 2, "must lie between 0 and 100"},
        {with("run: {threads: 0}"), 2, "must lie between 1 and 4096, not '0'"},
        {with("run: {threads: -2}"), 2, "must lie between 1 and 4096"},
        {with("run: {threads: 99999999999999}"), 2, "must lie between 1 and 4096"},
        {with("run: {threads: 2.5}"), 2, "must be a whole number or 'all', not '2.5'"},
        {with("run: {threads: 010}"), 2, "must be a whole number or 'all', not '010'"},
        {with("run: {threads: auto}"), 2, "must be a whole number or 'all', not 'auto'"},
        {with("run: {models_in_flight: all}"), 2, "must be a whole number or 'auto', not 'all'"},
        {with("run: {models_in_flight: 0}"), 2, "must lie between 1 and 65536"},
        {with("run: {memory: 70}"), 2, "must be a number and a unit (%, MB, GB or TB), not '70'"},
        {with("run: {memory: 70 kB}"), 2, "must be a number and a unit"},
        {with("run: {memory: 101%}"), 2, "must be 100% or less"},
        {with("run: {memory: 0%}"), 2, "must be above 0"},
        {with("run: {memory: -1 GB}"), 2, "must be a number and a unit"},
        {with("run: {model_memory: 10%}"), 2, "must be a number and a unit (MB, GB or TB), not '10%'"},
        {with("run: {isolation: thread}"), 2, "must be none or process"},
        {with("run: {model_timeout: 30}"), 2, "must be a number and a unit (s, min or h), not '30'"},
        {with("run: {model_timeout: 1..5 h}"), 2, "must be a number and a unit"},
    });
}

TEST(ConfigErrors, ChoicesGetTheNearestWord) {
    expect_errors({
        {with("coordinate_system: lps"), 2, "must be LPS, RAS or unknown, not 'lps'; did you mean 'LPS'?"},
        {with("centerlines: {refine: axial}"), 2, "must be none, path or medial, not 'axial'"},
        {with("centerlines: {join: middle}"), 2, "must be axis or centre, not 'middle'"},
        {with("centerlines: {pairs: nearst}"), 2, "did you mean 'nearest'?"},
        {with("archive: {precision: float46}"), 2, "did you mean 'float64'?"},
    });
}

TEST(ConfigErrors, IdsAreSafeFileNamesAndUnique) {
    auto id = [](const std::string& text) { return "cohort: c\nmodels:\n- {id: " + text + ", surface: a}\n"; };
    const Folder folder;
    for (const std::string good : {"a", "0", "A.b_c-d", "007"}) EXPECT_EQ(folder.error(id(good)), "") << good;
    EXPECT_EQ(folder.error(id(std::string(128, 'x'))), "");
    expect_errors({
        {id(std::string(129, 'x')), 3, "must not be longer than 128 characters, but has 129"},
        {id("a/b"), 3, "may hold only A-Z, a-z, 0-9, '.', '_' and '-'"},
        {id("a b"), 3, "may hold only"},
        {id("ä"), 3, "must start with a letter"},
        {id(".a"), 3, "must start with a letter A-Z, a-z or a digit"},
        {id("-a"), 3, "must start with"},
        {id("''"), 3, "must not be empty"},
        {"cohort: c\nmodels:\n- {id: Ab, surface: a}\n- {id: b, surface: a}\n- {id: aB, surface: a}\n", 5,
         "key 'id' gives the id 'aB' a second time; the first is 'Ab' in line 3"},
    });
}

TEST(ConfigErrors, CovariateNamesDoNotHideFieldsOrNestInTheArchive) {
    expect_errors({
        {model_with("covariates:\n      a/b: 1"), 6, "key 'a/b' cannot name a covariate"},
        {model_with("covariates: {..: 1}"), 5, "cannot name a covariate"},
        {model_with("covariates: {Subject: 1}"), 5, "every model has a field 'subject' of its own"},
        {model_with("covariates: {'': 1}"), 5, "must not be empty"},
        {model_with("covariates: {' a': 1}"), 5, "must not start or end with a blank"},
    });
}

TEST(ConfigErrors, YamlThatIsNoneGetsALineAndASentence) {
    expect_errors({
        {"cohort: c\nrun:\n\tthreads: 3\n", 3, "not valid YAML: "},
        {"cohort: c\nmodels: [a\n", 2, "not valid YAML: a '[' is not closed, or a ',' is missing"},
        {"cohort: c\nrun: {threads: 3\n", 2, "not valid YAML: a '{' is not closed"},
        {"cohort: c\nname: a: b\n", 2, "not valid YAML: "},
        {"cohort: c\nmodels: ]\n", 2, "not valid YAML: "},
        {"cohort: \"c\n", 1, "not valid YAML: a quote is not closed"},
        {"models: []\ncohort: 'c", 2, "not valid YAML: a quote is not closed"},
        {"models: []\ncohort: \"c\n\n", 3, "not valid YAML: a quote is not closed"},
        {"cohort: c\n  models: x\n", 2, "not valid YAML: "},
        {"cohort: c\nmodels: *m\n", 2, "an anchor that is not defined above it"},
        {"cohort: c\nmodels: @m\n", 2, "put the text in quotes"},
        {"cohort: c\nmodels: \"\\q\"\n", 2, "not valid YAML: "},
    });
}

TEST(ConfigErrors, YamlFeaturesThatWouldMisleadAreRefused) {
    expect_errors({
        {"cohort: c\nmodels: []\n---\ncohort: d\n", 3, "a second YAML document starts here"},
        {"cohort: c\nmodels:\n- &m {id: a, surface: a}\n- {<<: *m, id: b}\n", 4, "merge keys ('<<') are not supported"},
        {with("length_unit: !!str 5"), 2, "YAML tags are not supported; remove the tag"},
        {with("run: !mine {threads: 3}"), 2, "YAML tags are not supported"},
        {with("run: &r {threads: *r}"), 2, "an alias stands inside of the value that it refers to"},
        {"cohort: c\n? [a]\n: b\n", 2, "a key must be plain text, not a list or a map"},
        {"cohort: c\n~: b\n", 2, "a key must be plain text and not empty"},
        {"cohort: c\n: b\n", 2, "a key must be plain text and not empty"},
    });
}

TEST(ConfigErrors, MarkersAroundOneDocumentAreAccepted) {
    const Folder folder;
    EXPECT_EQ(folder.error("---\n" + with("")), "");
    EXPECT_EQ(folder.error("%YAML 1.2\n---\n" + with("") + "..."), "");
    EXPECT_EQ(folder.error("--- # a comment\n" + with("") + "...\n\n# another\n"), "");
}

TEST(ConfigErrors, TextThatIsNoTextIsRefused) {
    const std::string eot = "cohort: c\nmodels: [] # \x04\nrun: x\n";  // yaml-cpp ends the file here
    expect_errors({
        {eot, 2, "the control character 0x04 does not belong in a text file"},
        {std::string("cohort: c\0\nmodels: []\n", 22), 1, "the control character 0x00"},
        {"cohort: \xFF\n", 1, "the byte 0xFF is not valid UTF-8"},
        {"cohort: c\n# \xC3\n", 2, "the byte 0xC3 is not valid UTF-8"},
        {"cohort: \xC0\x80\n", 1, "the byte 0xC0 is not valid UTF-8"},
        {"cohort: \xED\xA0\x80\n", 1, "the byte 0xED is not valid UTF-8"},
        {std::string("\xFF\xFE"
                     "c\0",
                     4),
         1, "the file is UTF-16; save it as UTF-8"},
    });
}

TEST(ConfigErrors, LinesAreRightWithWindowsLineEnds) {
    expect_errors({
        {"\xEF\xBB\xBF"
         "cohort: c\r\nmodels:\r\n  - id: a\r\n    surfce: a.stl\r\n",
         4, "did you mean 'surface'?"},
        {"cohort: c\r\rrun: {threads: 0}\rmodels: [{id: a, surface: b}]\r", 3, "must lie between"},
    });
}

TEST(ConfigErrors, DeepNestingIsAnErrorNotACrash) {
    const Folder folder;
    EXPECT_NE(folder.error("cohort: " + std::string(100000, '[') + "\n"), "");
    EXPECT_NE(folder.error("cohort: " + std::string(100000, '{') + "\n"), "");
    std::string nested = "cohort: c\n";
    for (int i = 0; i < 3000; ++i) nested += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
    EXPECT_NE(folder.error(nested), "");
}

TEST(ConfigErrors, MissingFilesAreNamed) {
    const Folder folder;
    try {
        load_cohort(folder.path() / "absent.yaml");
        FAIL();
    } catch (const ConfigError& e) {
        EXPECT_EQ(e.line(), 0U);
        EXPECT_EQ(e.file(), folder.path() / "absent.yaml");
        EXPECT_NE(std::string(e.what()).find("cannot be read: No such file or directory"), std::string::npos);
    }
    EXPECT_THROW(load_cohort(folder.path()), ConfigError);
    expect_errors({
        {"cohort: c\nmodels:\n  table: absent.tsv\n", 3, "absent.tsv' cannot be read: No such file or directory"},
        {"cohort: c\nmodels:\n  table: .\n", 3, "must name a .tsv or .csv file"},
        {"cohort: c\nmodels:\n  glob: surfaces/*.stl\n", 3, "matches no file: 'surfaces/*.stl'"},
        {"cohort: c\nmodels:\n  glob: '**/*.stl'\n", 3, "must not hold '**'"},
    });
}

TEST(ConfigErrors, MissingSurfaceIsLeftToTheRun) {
    const Folder folder;
    EXPECT_EQ(folder.error(with("")), "");
}

TEST(ConfigErrors, GlobWithUnusableOrEqualStemsNamesTheFile) {
    const Folder folder;
    folder.write("s/my vessel.stl", "");
    EXPECT_NE(folder.error("cohort: c\nmodels: {glob: s/*}\n").find("the file name 's/my vessel.stl'"),
              std::string::npos);
    folder.write("t/a.stl", "");
    folder.write("t/A.ply", "");
    const std::string error = folder.error("cohort: c\nmodels: {glob: t/*}\n");
    EXPECT_EQ(error,
              "cohort.yaml:2: key 'glob': the file 't/a.stl' gives the id 'a' a second time; the first is 'A' of the "
              "file 't/A.ply' (ids differ by more than case)");
    folder.write("u/\xFF.stl", "");
    EXPECT_NE(folder.error("cohort: c\nmodels: {glob: u/*}\n").find("whose name is not UTF-8"), std::string::npos);
}

}  // namespace
}  // namespace lumenline
