// Each rule must fail on a planted violation, and keep quiet on the same file without it.
#include "tests/architecture/rules.h"

#include <gtest/gtest.h>

namespace lumenline::architecture {
namespace {

std::string include(const std::string& name) { return "#include " + name + "\n"; }

/// The violations of one file that includes one thing.
Violations of(const std::string& path, const std::string& name) { return include_violations({{path, include(name)}}); }

#define EXPECT_ALLOWED(path, name) EXPECT_TRUE(of(path, name).empty()) << (path) << " includes " << (name)
#define EXPECT_REFUSED(path, name) EXPECT_EQ(of(path, name).size(), 1U) << (path) << " includes " << (name)

TEST(IncludeRules, StageSeesCoreGeometryAndItself) {
    EXPECT_ALLOWED("engine/trace/a.cpp", "\"engine/core/vec3.h\"");
    EXPECT_ALLOWED("engine/trace/a.h", "\"engine/geometry/inside_test.h\"");
    EXPECT_ALLOWED("engine/trace/a.cpp", "\"engine/trace/path.h\"");
    EXPECT_ALLOWED("engine/trace/a.cpp", "<vector>");
}

TEST(IncludeRules, StageSeesNoNeighbourSchedulerIoOrConfig) {
    for (const char* stage : {"condition", "voronoi", "endpoints", "eikonal", "trace"}) {
        const std::string path = std::string("engine/") + stage + "/a.cpp";
        for (const char* other : {"condition", "voronoi", "endpoints", "eikonal", "trace"}) {
            if (std::string(other) == stage) continue;
            EXPECT_REFUSED(path, "\"engine/" + std::string(other) + "/a.h\"");
        }
        for (const char* other : {"engine/phantom", "engine/schedule", "engine/cli", "io/mesh", "io/archive", "config"})
            EXPECT_REFUSED(path, "\"" + std::string(other) + "/a.h\"");
    }
}

TEST(IncludeRules, CoreSeesNothingAndGeometryOnlyCore) {
    EXPECT_ALLOWED("engine/core/a.h", "\"engine/core/b.h\"");
    EXPECT_REFUSED("engine/core/a.h", "\"engine/geometry/b.h\"");
    EXPECT_REFUSED("engine/core/a.cpp", "\"io/mesh/b.h\"");
    EXPECT_ALLOWED("engine/geometry/a.cpp", "\"engine/core/b.h\"");
    EXPECT_REFUSED("engine/geometry/a.cpp", "\"engine/voronoi/b.h\"");
}

TEST(IncludeRules, IoAndConfigSeeOnlyCore) {
    EXPECT_ALLOWED("io/archive/a.cpp", "\"engine/core/b.h\"");
    EXPECT_ALLOWED("io/archive/a.cpp", "\"io/mesh/b.h\"");
    EXPECT_REFUSED("io/archive/a.cpp", "\"engine/geometry/b.h\"");
    EXPECT_REFUSED("io/mesh/a.cpp", "\"config/b.h\"");
    EXPECT_REFUSED("io/mesh/a.cpp", "\"engine/schedule/b.h\"");
    EXPECT_ALLOWED("config/a.cpp", "\"engine/core/b.h\"");
    EXPECT_ALLOWED("config/a.cpp", "\"config/b.h\"");
    EXPECT_REFUSED("config/a.cpp", "\"engine/trace/b.h\"");
    EXPECT_REFUSED("config/a.cpp", "\"io/mesh/b.h\"");
}

TEST(IncludeRules, ScheduleSeesStagesButNeitherIoNorConfigNorCli) {
    EXPECT_ALLOWED("engine/schedule/a.cpp", "\"engine/trace/trace.h\"");
    EXPECT_REFUSED("engine/schedule/a.cpp", "\"io/archive/model_file.h\"");
    EXPECT_REFUSED("engine/schedule/a.cpp", "\"config/cohort.h\"");
    EXPECT_REFUSED("engine/schedule/a.cpp", "\"engine/cli/run.h\"");
}

TEST(IncludeRules, PopulationSeesTablesAlone) {
    EXPECT_ALLOWED("engine/population/a.cpp", "\"engine/core/data_table.h\"");
    for (const char* room : {"engine/geometry", "engine/trace", "io/archive", "config"})
        EXPECT_REFUSED("engine/population/a.cpp", "\"" + std::string(room) + "/a.h\"");
}

TEST(IncludeRules, CliSeesEverything) {
    for (const char* room :
         {"engine/schedule", "engine/phantom", "engine/population", "engine/trace", "io/archive", "io/mesh", "config"})
        EXPECT_ALLOWED("engine/cli/a.cpp", "\"" + std::string(room) + "/a.h\"");
}

TEST(IncludeRules, HeavyLibrariesStayInTheirRooms) {
    EXPECT_ALLOWED("engine/geometry/a.cpp", "<CGAL/AABB_tree.h>");
    EXPECT_REFUSED("engine/eikonal/a.cpp", "<CGAL/AABB_tree.h>");
    EXPECT_REFUSED("engine/core/a.h", "<CGAL/AABB_tree.h>");
    EXPECT_ALLOWED("engine/schedule/a.cpp", "<tbb/flow_graph.h>");
    EXPECT_REFUSED("engine/voronoi/a.cpp", "<tbb/parallel_for.h>");
    EXPECT_REFUSED("engine/voronoi/a.cpp", "<oneapi/tbb.h>");
    EXPECT_REFUSED("engine/voronoi/a.cpp", "<thread>");
    EXPECT_ALLOWED("io/archive/a.cpp", "<hdf5.h>");
    EXPECT_REFUSED("io/mesh/a.cpp", "<hdf5.h>");
    EXPECT_REFUSED("engine/cli/a.cpp", "<H5Fpublic.h>");
    EXPECT_ALLOWED("config/a.cpp", "<yaml-cpp/parser.h>");
    EXPECT_REFUSED("engine/cli/a.cpp", "<yaml-cpp/parser.h>");
    EXPECT_ALLOWED("engine/condition/a.cpp", "<OpenMesh/Core/Mesh/Traits.hh>");
    EXPECT_ALLOWED("io/mesh/a.cpp", "<OpenMesh/Core/Mesh/Traits.hh>");
    EXPECT_REFUSED("engine/trace/a.cpp", "<OpenMesh/Core/Mesh/Traits.hh>");
    EXPECT_REFUSED("engine/cli/a.cpp", "<openssl/evp.h>");
    EXPECT_REFUSED("io/mesh/a.cpp", "<vtkPolyData.h>");
    EXPECT_REFUSED("engine/core/a.cpp", "<gtest/gtest.h>");
}

TEST(IncludeRules, PrivateHeaderMayNameItsRoomsLibrary) {
    const Tree tree{{"io/archive/handle.h", include("<hdf5.h>")},
                    {"io/archive/writer.h", include("\"io/archive/handle.h\"")},
                    {"io/archive/a.cpp", include("\"io/archive/writer.h\"")}};
    EXPECT_TRUE(include_violations(tree).empty());
}

TEST(IncludeRules, HeaderReachedFromAnotherRoomMayNot) {
    const Tree tree{{"io/archive/handle.h", include("<hdf5.h>")},
                    {"io/archive/writer.h", include("\"io/archive/handle.h\"")},
                    {"engine/cli/a.cpp", include("\"io/archive/writer.h\"")}};
    const Violations violations = include_violations(tree);
    ASSERT_EQ(violations.size(), 1U);
    EXPECT_EQ(violations[0], "io/archive/handle.h:1: HDF5 is in a header that engine/cli/a.cpp reaches");
}

TEST(IncludeRules, CircleOfHeadersEnds) {
    const Tree tree{{"engine/core/a.h", include("\"engine/core/b.h\"")},
                    {"engine/core/b.h", include("\"engine/core/a.h\"")}};
    EXPECT_TRUE(include_violations(tree).empty());
}

TEST(IncludeRules, UnusualSpellingsAreSeen) {
    EXPECT_REFUSED("engine/trace/a.cpp", "  <tbb/tbb.h>  // comment");
    EXPECT_EQ(include_violations({{"engine/trace/a.cpp", "  #  include<tbb/tbb.h>"}}).size(), 1U);
    EXPECT_EQ(include_violations({{"engine/trace/a.cpp", "#if 0\n#include \"io/mesh/mesh_io.h\"\n#endif\n"}}).size(),
              1U);
    EXPECT_REFUSED("engine/trace/a.cpp", "HEADER_NAME");
    EXPECT_REFUSED("engine/trace/a.cpp", "\"path.h\"");
    EXPECT_REFUSED("engine/trace/a.cpp", "\"../voronoi/voronoi.h\"");
    EXPECT_REFUSED("engine/trace/a.cpp", "<engine/core/vec3.h>");
    EXPECT_REFUSED("engine/trace/a.cpp", "\"engine/trace/path.cpp\"");
}

TEST(IncludeRules, ViolationNamesFileAndLine) {
    const Violations violations =
        include_violations({{"engine/trace/a.cpp", "// method\n\n#include \"io/mesh/b.h\"\n"}});
    ASSERT_EQ(violations.size(), 1U);
    EXPECT_EQ(violations[0], "engine/trace/a.cpp:3: engine/trace may not include io/mesh");
}

TEST(IncludeRules, RoomWithoutRuleIsRefused) {
    EXPECT_EQ(include_violations({{"engine/attic/a.cpp", ""}}).size(), 1U);
    EXPECT_EQ(include_violations({{"engine/a.cpp", ""}}).size(), 1U);
}

TEST(SizeRules, OneLineTooManyIsRefused) {
    const auto lines = [](std::size_t count) {
        std::string text;
        for (std::size_t i = 0; i < count; ++i) text += "x\n";
        return text;
    };
    EXPECT_TRUE(size_violations({{"a.h", lines(150)}, {"a.cpp", lines(400)}}).empty());
    EXPECT_EQ(size_violations({{"a.h", lines(151)}}).size(), 1U);
    EXPECT_EQ(size_violations({{"a.cpp", lines(401)}}).size(), 1U);
    EXPECT_EQ(size_violations({{"a.h", lines(150) + "x"}}).size(), 1U);
}

TEST(WordingRules, MarksOfUnfinishedWorkAreRefused) {
    EXPECT_TRUE(wording_violations({{"a.cpp", "// a method that stands\n"}}).empty());
    EXPECT_EQ(wording_violations({{"a.cpp", std::string("int a;\n// TO") + "DO: later\n"}}),
              Violations{std::string("a.cpp:2: unfinished: // TO") + "DO: later"});
    EXPECT_EQ(wording_violations({{"a.h", std::string("// FIX") + "ME\n"}}).size(), 1U);
}

TEST(ListingRules, SourceThatIsNotBuiltIsRefused) {
    EXPECT_TRUE(
        listing_violations(
            {{"e/CMakeLists.txt", "target_sources(x PRIVATE a.cpp c/b.cpp)"}, {"e/a.cpp", ""}, {"e/c/b.cpp", ""}})
            .empty());
    EXPECT_EQ(listing_violations({{"e/CMakeLists.txt", "target_sources(x PRIVATE aa.cpp)"}, {"e/a.cpp", ""}}).size(),
              1U);
    EXPECT_EQ(listing_violations({{"e/a.cpp", ""}}).size(), 1U);
}

}  // namespace
}  // namespace lumenline::architecture
