// Tables of models: columns, cells, quoting, and the place of every error.

#include "tests/config/support.h"

namespace lumenline {
namespace {

using testing::Folder;
using Covariates = std::vector<std::pair<std::string, std::string>>;

std::string cohort_of(const std::string& table) { return "cohort: c\nmodels:\n  table: " + table + "\n"; }

std::vector<ModelTask> load(const std::string& content, const std::string& name = "t.tsv") {
    const Folder folder;
    folder.write(name, content);
    return folder.load(cohort_of(name)).tasks;
}

std::string error(const std::string& content, const std::string& name = "t.tsv") {
    const Folder folder;
    folder.write(name, content);
    return folder.error(cohort_of(name));
}

TEST(Table, EveryColumnHasItsEffect) {
    const std::vector<ModelTask> tasks = load(
        "id\tsurface\tsubject\tsession\tside\tstructure\tgroup\tinlets\toutlets\tscale\tage\n"
        "a\ts/a.stl\tP1\tbase\tleft\taorta\tctrl\t0,0,0\t1,2,3\t0.5\t063\n");
    ASSERT_EQ(tasks.size(), 1U);
    const ModelIdentity& who = tasks[0].identity;
    EXPECT_EQ(who.id, "a");
    EXPECT_EQ(who.source_file, "s/a.stl");
    EXPECT_EQ(who.subject, "P1");
    EXPECT_EQ(who.session, "base");
    EXPECT_EQ(who.side, "left");
    EXPECT_EQ(who.structure, "aorta");
    EXPECT_EQ(who.group, "ctrl");
    EXPECT_EQ(tasks[0].scale, 0.5);
    EXPECT_EQ(tasks[0].options.endpoints.inlets, (std::vector<Vec3>{{0, 0, 0}}));
    EXPECT_EQ(tasks[0].options.endpoints.outlets, (std::vector<Vec3>{{1, 2, 3}}));
    EXPECT_EQ(who.covariates, (Covariates{{"age", "063"}}));
}

TEST(Table, SurfacesAreRelativeToTheCohortFile) {
    const Folder folder;
    folder.write("lists/t.tsv", "id\tsurface\na\ts/a.stl\n");
    const CohortConfig config = folder.load(cohort_of("lists/t.tsv"));
    EXPECT_EQ(config.tasks.at(0).surface_path, (folder.path() / "s/a.stl").string());
}

TEST(Table, FourInletsInOneCellAndSingularColumnNames) {
    const std::vector<ModelTask> tasks =
        load("id\tsurface\tinlet\toutlet\na\ta.stl\t1,2,3;4,5,6; 7, 8, 9 ;-1e1,.5,0\t0,0,1\n");
    EXPECT_EQ(tasks.at(0).options.endpoints.inlets,
              (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {-10, 0.5, 0}}));
    EXPECT_EQ(tasks.at(0).options.endpoints.outlets, (std::vector<Vec3>{{0, 0, 1}}));
}

TEST(Table, MissingCellsAreDefaultsAndMissingCovariates) {
    const std::vector<ModelTask> tasks =
        load("age\tid\tsubject\tinlets\tscale\tsurface\tsex\nn/a\ta\tn/a\tn/a\tn/a\ta.stl\tF\n3\tb\t\t\t\tb.stl\t\n");
    for (const ModelTask& task : tasks) {
        EXPECT_EQ(task.identity.subject, "");
        EXPECT_TRUE(task.options.endpoints.inlets.empty());
        EXPECT_EQ(task.scale, 1);
    }
    EXPECT_EQ(tasks.at(0).identity.covariates, (Covariates{{"age", "n/a"}, {"sex", "F"}}));
    EXPECT_EQ(tasks.at(1).identity.covariates, (Covariates{{"age", "3"}, {"sex", "n/a"}}));
}

TEST(Table, CsvCellsMayBeQuoted) {
    const std::vector<ModelTask> tasks = load(
        "id, surface ,inlets,\"note, long\",\"quote \"\"x\"\"\"\n"
        "a,\"dir, with comma/a.stl\", \"1,2,3;4,5,6\" ,\"  kept  \",\"say \"\"hi\"\"\"\nb,b.stl,,,\"\"\n",
        "t.CSV");
    EXPECT_EQ(tasks.at(0).identity.source_file, "dir, with comma/a.stl");
    EXPECT_EQ(tasks.at(0).options.endpoints.inlets.size(), 2U);
    EXPECT_EQ(tasks.at(0).identity.covariates, (Covariates{{"note, long", "  kept  "}, {"quote \"x\"", "say \"hi\""}}));
    EXPECT_EQ(tasks.at(1).identity.covariates, (Covariates{{"note, long", "n/a"}, {"quote \"x\"", "n/a"}}));
}

TEST(Table, TsvCellsQuotedByASpreadsheetAreRead) {
    const auto rules =
        load("id\tsurface\tinlet\na\ta.stl\thighest z; nearest [1,2,3]\n").at(0).options.endpoints.inlet_rules;
    ASSERT_EQ(rules.size(), 2U);
    EXPECT_EQ(rules[1].point, (Vec3{1, 2, 3}));
    EXPECT_EQ(load("id\tsurface\tinlets\na\ta.stl\t\"1,2,3\"\n").at(0).options.endpoints.inlets,
              (std::vector<Vec3>{{1, 2, 3}}));
}

TEST(Table, WindowsLineEndsByteOrderMarkAndBlankLinesChangeNothing) {
    const std::vector<ModelTask> tasks = load("\xEF\xBB\xBFid\tsurface\tage\r\n\r\na\ta.stl\t3\r\n  \r\nb\tb.stl\t4");
    ASSERT_EQ(tasks.size(), 2U);
    EXPECT_EQ(tasks[0].identity.id, "a");
    EXPECT_EQ(tasks[1].identity.covariates, (Covariates{{"age", "4"}}));
}

TEST(TableErrors, NameFileLineAndColumn) {
    const std::string head = "id\tsurface\tinlets\tscale\tage\n";
    EXPECT_EQ(error(head + "a\ta.stl\t\t1\t3\nb\tb.stl\t\t0\t3\n"),
              "t.tsv:3: column 'scale' must be greater than 0, not '0'");
    EXPECT_EQ(error(head + "a\ta.stl\t\t0x1\t3\n"),
              "t.tsv:2: column 'scale' must be a decimal number such as 12.5 or 1e-7, not '0x1'");
    EXPECT_EQ(error(head + "\na b\ta.stl\t\t1\t3\n"),
              "t.tsv:3: column 'id' may hold only A-Z, a-z, 0-9, '.', '_' and '-', because it names a file: 'a b'");
    EXPECT_EQ(error(head + "n/a\ta.stl\t\t1\t3\n"), "t.tsv:2: column 'id' must not be empty");
    EXPECT_EQ(error(head + "a\t\t\t1\t3\n"), "t.tsv:2: column 'surface' must not be empty");
    EXPECT_EQ(error(head + "a\ta.stl\t\t1\t3\nA\tb.stl\t\t1\t3\n"),
              "t.tsv:3: column 'id' gives the id 'A' a second time; the first is 'a' in line 2 (ids differ by more "
              "than case)");
}

TEST(TableErrors, PointsThatAreNone) {
    for (const std::string cell :
         {"1,2", "1,2,3,4", "1,2,3;", ";1,2,3", "1 2 3", "1,2,x", "1,,3", "(1,2,3)", "1,2,nan"})
        EXPECT_TRUE(error("id\tsurface\tinlet\na\ta.stl\t" + cell + "\n").starts_with("t.tsv:2: column 'inlet' must "))
            << cell;
    EXPECT_EQ(error("id\tsurface\tinlet\na\ta.stl\t1,2,3;4,5\n"),
              "t.tsv:2: column 'inlet' must hold points as x,y,z with ';' between them, not '4,5'");
}

TEST(TableErrors, HeadersThatAreAmbiguous) {
    const std::string row = "a\ta.stl\t1\t2\n";
    EXPECT_EQ(error("id\tsurface\tage\tage\n" + row), "t.tsv:1: the column 'age' appears twice, as columns 3 and 4");
    EXPECT_EQ(error("id\tsurface\tage\t\n" + row), "t.tsv:1: column 4 has no name");
    EXPECT_EQ(error("id\tsurface\tinlet\tinlets\n" + row),
              "t.tsv:1: column 'inlets' and column 'inlet' mean the same; keep one");
    EXPECT_EQ(error("id\tsurface\tscael\tage\n" + row),
              "t.tsv:1: column 'scael' is too close to 'scale'; write 'scale', or give the covariate another name");
    EXPECT_NE(error("id\tsurface\tSide\tage\n" + row).find("too close to 'side'"), std::string::npos);
    EXPECT_NE(error("id\tsurface\ta/b\tage\n" + row).find("cannot name a covariate"), std::string::npos);
    EXPECT_NE(error("id\tsurface\tcovariates\tage\n" + row).find("cannot name a covariate"), std::string::npos);
    EXPECT_EQ(error("id\tsurface\tsize\tage\n" + row), "");
}

TEST(TableErrors, MissingColumnsListWhatIsThere) {
    EXPECT_EQ(error("participant_id\tsurface\na\ta.stl\n"),
              "t.tsv:1: column 'id' is missing; the table has participant_id, surface (tab-separated)");
    EXPECT_NE(error("id;surface\na;a.stl\n", "t.csv").find("t.csv:1: column 'id' is missing"), std::string::npos);
    EXPECT_NE(error("id\tage\na\t3\n").find("column 'surface' is missing"), std::string::npos);
}

TEST(TableErrors, RowsAndQuotesThatDoNotFit) {
    const std::string head = "id\tsurface\tage\n";
    EXPECT_EQ(error(head + "a\ta.stl\n"),
              "t.tsv:2: the row has 2 cells where the header has 3 columns; is a tab missing or too many?");
    EXPECT_EQ(error("id,surface\na,b,c\n", "t.csv"),
              "t.csv:2: the row has 3 cells where the header has 2 columns; is a comma missing or too many?");
    EXPECT_EQ(error(head + "a\ta.stl\t\"x\n"), "t.tsv:2: cell 3 has a quote that is not closed on its line");
    EXPECT_EQ(error(head + "a\t\"a.stl\"x\t1\n"), "t.tsv:2: cell 2 goes on after its closing quote: 'x'");
}

TEST(TableErrors, FilesThatHoldNoTable) {
    EXPECT_EQ(error(""), "t.tsv:1: the table is empty; it needs a header row");
    EXPECT_EQ(error("\n\n"), "t.tsv:1: the table is empty; it needs a header row");
    EXPECT_EQ(error("\nid\tsurface\n"), "t.tsv:2: the table has a header but no rows");
    EXPECT_NE(error("id\tsurface\n", "t.xlsx").find("cohort.yaml:3: key 'table' must name a .tsv or .csv file"),
              std::string::npos);
    EXPECT_EQ(error("id\tsurface\na\t\xE9.stl\n"), "t.tsv:2: the byte 0xE9 is not valid UTF-8; save the file as UTF-8");
    EXPECT_EQ(error(std::string("\xFF\xFEi\0d\0", 6)), "t.tsv:1: the file is UTF-16; save it as UTF-8");
}

}  // namespace
}  // namespace lumenline
