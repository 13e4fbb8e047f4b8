// What is read back is compared with the record, bit for bit where the format keeps doubles.

#include "io/archive/model_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <limits>

#include "io/archive/handle.h"
#include "io/archive/index.h"
#include "io/archive/read.h"
#include "tests/archive/sample_record.h"

namespace lumenline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Numbers = std::vector<double>;
using Strings = std::vector<std::string>;
using Shape = std::vector<std::uint64_t>;

ArchiveFile written(const ModelRecord& record, const std::string& name, const ArchiveOptions& options = {}) {
    const std::filesystem::path file = fresh_directory(name) / "m.hdf";
    write_model_file(file, record, options);
    EXPECT_FALSE(std::filesystem::exists(file.string() + ".tmp"));
    return ArchiveFile(file);
}

Numbers flat(const std::vector<Vec3>& points) {
    Numbers numbers;
    for (const Vec3& p : points) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    return numbers;
}

TEST(ModelFile, SurfaceComesBackExactly) {
    const ModelRecord record = sample_record();
    const ArchiveFile file = written(record, "surface");
    EXPECT_EQ(file.numbers("/surface/points"), flat(record.surface->points));
    EXPECT_EQ(file.shape("/surface/points"), (Shape{5, 3}));
    EXPECT_EQ(file.numbers("/surface/normals"), flat(record.surface->normals));
    EXPECT_EQ(file.numbers("/surface/triangles"), (Numbers{0, 1, 2, 0, 2, 3, 0, 3, 1, 4, 2, 1, 4, 3, 2, 4, 1, 3}));
    EXPECT_EQ(file.numbers("/surface/input_vertex"), (Numbers{0, 1, 2, -1, -1}));
    EXPECT_EQ(file.numbers("/surface/origin"), (Numbers{0, 0, 0, 1, 2}));
    EXPECT_EQ(file.numbers("/surface/pole"), (Numbers{0, 3, -1, 6, 2}));
    EXPECT_EQ(file.attribute("/surface", "genus"), "1");
    EXPECT_EQ(file.attribute("/surface/points", "units"), "mm");
    EXPECT_EQ(file.attribute("/surface/normals", "units"), "1");
}

TEST(ModelFile, CapNamesTheEndpointNotTheOpening) {
    // Openings of the triangles: none, 0, 1, 2, none, 1; opening 1 is endpoint 0, opening 0 is endpoint 1.
    EXPECT_EQ(written(sample_record(), "cap").numbers("/surface/cap"), (Numbers{-1, 1, 0, -2, -1, 0}));
}

TEST(ModelFile, BareEdgesKeepTwoVerticesAndNoSites) {
    const ArchiveFile file = written(sample_record(), "bare");
    EXPECT_EQ(file.numbers("/voronoi/polygon_offsets"), (Numbers{0, 4, 6, 9}));
    EXPECT_EQ(file.numbers("/voronoi/polygon_vertices"), (Numbers{0, 1, 2, 3, 3, 4, 4, 5, 6}));
    EXPECT_EQ(file.numbers("/voronoi/polygon_sites"), (Numbers{0, 1, -1, -1, 2, 3}));
}

TEST(ModelFile, UnreachedTimesStayInfiniteInBothPrecisions) {
    const ModelRecord record = sample_record();
    for (const bool single : {true, false}) {
        const ArchiveFile file = written(record, "unreached", {.float32_fields = single});
        const Numbers times = file.numbers("/voronoi/arrival_time");
        EXPECT_EQ(file.shape("/voronoi/arrival_time"), (Shape{2, 7}));
        ASSERT_EQ(times.size(), 14U);
        EXPECT_EQ(times[6], kInfinity);
        EXPECT_EQ(times[13], 2);
        EXPECT_EQ(times[1], single ? static_cast<double>(1.0F / 3.0F) : 1.0 / 3);
        EXPECT_EQ(file.numbers("/voronoi/sources"), (Numbers{0, 2}));
        EXPECT_EQ(file.numbers("/voronoi/reached"), (Numbers{6, 7}));
        EXPECT_EQ(file.numbers("/voronoi/ball_radius"), record.complex->ball_radius) << "radii are always double";
    }
}

TEST(ModelFile, LinesAndPathsComeBackExactly) {
    const ModelRecord record = sample_record();
    const ArchiveFile file = written(record, "lines");
    const Centerlines& lines = *record.centerlines;
    EXPECT_EQ(file.numbers("/centerlines/points"), flat(lines.points));
    EXPECT_EQ(file.numbers("/centerlines/offsets"), (Numbers{0, 5, 9}));
    EXPECT_EQ(file.numbers("/centerlines/radius"), lines.radius);
    EXPECT_EQ(file.numbers("/centerlines/clearance"), lines.clearance);
    EXPECT_EQ(file.numbers("/centerlines/radius_error"), lines.radius_error);
    const Numbers position_error = file.numbers("/centerlines/position_error");
    ASSERT_EQ(position_error.size(), lines.position_error.size());
    EXPECT_TRUE(std::isnan(position_error[3]));
    EXPECT_EQ(position_error[4], lines.position_error[4]);
    EXPECT_EQ(file.numbers("/centerlines/target"), (Numbers{1, 3}));
    EXPECT_EQ(file.numbers("/centerlines/loop"), (Numbers{-1, -1}));
    EXPECT_EQ(file.numbers("/loops/point"), (Numbers{0.25, 0.5, 0.75}));
    EXPECT_EQ(file.numbers("/loops/arrival_time"), (Numbers{3.5}));
    EXPECT_EQ(file.numbers("/centerlines/path/line_abscissa"), lines.path.line_abscissa);
}

TEST(ModelFile, EndpointsAndTextComeBack) {
    const ArchiveFile file = written(sample_record(), "text");
    EXPECT_EQ(file.strings("/endpoints/role"), (Strings{"inlet", "outlet", "outlet", "outlet"}));
    EXPECT_EQ(file.strings("/endpoints/kind"), (Strings{"boundary", "boundary", "point", "point"}));
    EXPECT_EQ(file.attribute("/", "source_file"), "surfaces/h\xC3\xA9patique.stl");
    EXPECT_EQ(file.strings("/covariates/value"), (Strings{"63", "f", "1.7"}));
    EXPECT_EQ(file.strings("/diagnostics/severity"), (Strings{"warning", "note"}));
    EXPECT_TRUE(std::isnan(file.numbers("/diagnostics/limit")[1]));
}

TEST(ModelFile, TextThatIsNoUtf8IsReplaced) {
    ModelRecord record = sample_record();
    record.identity.source_file = std::string("a\xFF") + '\0' + "b";
    record.identity.subject.clear();
    const ArchiveFile file = written(record, "utf8");
    EXPECT_EQ(file.attribute("/", "source_file"),
              "a\xEF\xBF\xBD\xEF\xBF\xBD"
              "b");
    EXPECT_EQ(file.attribute("/", "subject"), "");
}

TEST(ModelFile, AttributeLongerThanHdf5AllowsIsCut) {
    ModelRecord record = failed_record();
    record.failure->sentence.assign(100000, 'x');
    EXPECT_EQ(written(record, "long").attribute("/", "failure_sentence")->size(), 60000U);
}

TEST(ModelFile, FailedModelKeepsWhatItReached) {
    const ArchiveFile file = written(failed_record(), "failed");
    EXPECT_EQ(file.attribute("/", "status"), "failed");
    EXPECT_EQ(file.attribute("/", "failure_stage"), "eikonal");
    EXPECT_EQ(file.attribute("/", "failure_code"), "no_seed");
    EXPECT_EQ(file.attribute("/", "failure_sentence"), "a front needs at least one vertex to start from");
    EXPECT_EQ(file.numbers("/surface/cap"), (Numbers{-1, -2, -2, -2, -1, -2}));
    EXPECT_EQ(file.shape("/voronoi/vertices"), (Shape{7, 3}));
    for (const char* absent : {"/endpoints", "/centerlines", "/voronoi/arrival_time", "/characterization"})
        EXPECT_FALSE(file.has(absent));
    EXPECT_EQ(file.numbers("/VTKHDF/NumberOfCells"), Numbers{6});
}

TEST(ModelFile, ModelWithoutAnySurfaceIsStillAFile) {
    ModelRecord record;
    record.identity.id = "nothing";
    record.failure = Failure{Stage::kLoad, ErrorCode::kFileUnreadable, "no such file"};
    const ArchiveFile file = written(record, "nothing");
    for (const char* absent : {"/surface", "/voronoi", "/endpoints", "/centerlines", "/VTKHDF"})
        EXPECT_FALSE(file.has(absent));
    EXPECT_TRUE(file.strings("/diagnostics/message").empty());
    EXPECT_EQ(file.strings("/timing/stage").size(), static_cast<std::size_t>(kStageCount));
}

TEST(ModelFile, SummaryOfTheFileIsTheSummaryOfTheRecord) {
    for (ModelRecord record : {sample_record(), failed_record(), ModelRecord{}}) {
        if (record.status == ModelStatus::kFailed && !record.failure) record.failure = Failure{};
        EXPECT_EQ(difference(summarize(record), read_summary(written(record, "summary").file())), "");
    }
    ModelRecord other = sample_record();
    other.facts.total_seconds = 3;
    EXPECT_EQ(difference(summarize(other), read_summary(written(sample_record(), "summary").file())), "seconds");
}

TEST(ModelFile, LinesWithoutPointsAreKept) {
    ModelRecord record = sample_record();
    auto lines = std::make_shared<Centerlines>();
    lines->offsets = lines->path.offsets = {0};
    record.centerlines = lines;
    record.branches = nullptr;
    const ArchiveFile file = written(record, "no_lines");
    EXPECT_EQ(file.shape("/centerlines/points"), (Shape{0, 3}));
    EXPECT_EQ(difference(summarize(record), read_summary(file.file())), "");
}

TEST(ModelFile, EqualRecordsGiveEqualBytes) {
    const auto first = written(sample_record(), "equal_1").file();
    const auto second = written(sample_record(), "equal_2").file();
    EXPECT_EQ(bytes_of(first), bytes_of(second));
}

TEST(ModelFile, OtherRunFactsChangeNothingElse) {
    ModelRecord other = sample_record();
    other.facts.stage_seconds.fill(9);
    other.facts.total_seconds = 99;
    other.facts.threads = 64;
    other.facts.peak_resident_bytes = 1;
    const ArchiveFile a = written(sample_record(), "facts_1");
    const ArchiveFile b = written(other, "facts_2");
    EXPECT_NE(bytes_of(a.file()), bytes_of(b.file()));
    std::size_t compared = 0;
    for (const ArchiveNode& node : a.nodes()) {
        if (node.path.starts_with("/timing") || node.path.starts_with("/provenance")) continue;
        EXPECT_EQ(a.attributes(node.path), b.attributes(node.path)) << node.path;
        if (node.is_group) continue;
        ++compared;
        std::ostringstream left, right;
        a.print(node.path, left);
        b.print(node.path, right);
        EXPECT_EQ(left.str(), right.str()) << node.path;
    }
    EXPECT_GT(compared, 40U);
    EXPECT_NE(a.numbers("/timing/seconds"), b.numbers("/timing/seconds"));
}

TEST(ModelFile, NoObjectCarriesATimeStamp) {
    const ArchiveFile file = written(sample_record(), "stamps");
    const hdf::Handle raw(H5Fopen(file.file().c_str(), H5F_ACC_RDONLY, hdf::file_access().get()), H5Fclose, "open");
    for (const ArchiveNode& node : file.nodes()) {
        H5O_info_t info{};
        hdf::checked(H5Oget_info_by_name2(raw.get(), node.path.c_str(), &info, H5O_INFO_TIME, H5P_DEFAULT), node.path);
        EXPECT_EQ(info.atime + info.mtime + info.ctime + info.btime, 0) << node.path;
    }
}

TEST(ModelFile, ContradictingArraysAreRefused) {
    const auto refused = [](const auto& damage) {
        ModelRecord record = sample_record();
        damage(record);
        const std::filesystem::path file = fresh_directory("contradiction") / "m.hdf";
        try {
            write_model_file(file, record);
            ADD_FAILURE() << "written";
        } catch (const StageError& error) {
            EXPECT_EQ(error.code(), ErrorCode::kInternal);
            EXPECT_EQ(error.stage(), Stage::kArchive);
            EXPECT_FALSE(std::filesystem::exists(file));
            EXPECT_FALSE(std::filesystem::exists(file.string() + ".tmp"));
            return std::string(error.what());
        }
        return std::string();
    };
    const auto change_surface = [](ModelRecord& record, const auto& change) {
        auto surface = std::make_shared<Surface>(*record.surface);
        change(*surface);
        record.surface = surface;
    };
    EXPECT_NE(refused([&](ModelRecord& r) {
                  change_surface(r, [](Surface& s) { s.normals.pop_back(); });
              }).find("/surface/normals has 4 rows where the record asks for 5"),
              std::string::npos);
    EXPECT_NE(refused([&](ModelRecord& r) {
                  change_surface(r, [](Surface& s) { s.triangles[2][1] = SiteId(3000000000U); });
              }).find("index 3000000000 in row 2"),
              std::string::npos);
    EXPECT_NE(refused([&](ModelRecord& r) {
                  change_surface(r, [](Surface& s) { s.cap[0] = OpeningId(17); });
              }).find("opening 17 does not exist: the surface has 3 openings"),
              std::string::npos);
    EXPECT_NE(refused([](ModelRecord& r) {
                  auto lines = std::make_shared<Centerlines>(*r.centerlines);
                  lines->offsets.back() = 8;
                  r.centerlines = lines;
              }).find("ends at 8"),
              std::string::npos);
    EXPECT_NE(refused([](ModelRecord& r) {
                  auto field = std::make_shared<ArrivalField>(*r.fields[1]);
                  field->time.push_back(1);
                  r.fields[1] = field;
              }).find("8 columns"),
              std::string::npos);
}

TEST(ModelFile, DirectoryThatDoesNotExistIsNamed) {
    const std::filesystem::path file = fresh_directory("absent") / "no" / "m.hdf";
    try {
        write_model_file(file, sample_record());
        FAIL();
    } catch (const StageError& error) {
        EXPECT_EQ(error.code(), ErrorCode::kArchiveWrite);
        EXPECT_NE(std::string(error.what()).find("No such file or directory"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos);
    }
}

/// Writes a record to `file` in a child process that may write no file larger than `bytes`.
int status_of_limited_writer(const std::filesystem::path& file, const ModelRecord& record, rlim_t bytes, bool killed) {
    const pid_t child = ::fork();
    if (child == 0) {
        const rlimit limit{bytes, bytes};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        std::signal(SIGXFSZ, killed ? SIG_DFL : SIG_IGN);
        try {
            write_model_file(file, record);
        } catch (const StageError& error) {
            // exit, not _exit: HDF5's own clean-up at exit must survive the failed write too.
            std::exit(error.code() == ErrorCode::kArchiveWrite ? 3 : 4);
        }
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
}

/// A record whose file is larger than the limit below by far.
ModelRecord large_record() {
    ModelRecord record = sample_record();
    auto surface = std::make_shared<Surface>(*record.surface);
    constexpr std::size_t kSites = 20000;
    surface->points.resize(kSites, {1, 2, 3});
    surface->normals.resize(kSites, {0, 0, 1});
    surface->input_vertex.resize(kSites, 0);
    surface->origin.resize(kSites, SiteOrigin::kWall);
    auto complex = std::make_shared<VoronoiComplex>(*record.complex);
    complex->pole.resize(kSites);
    record.surface = surface;
    record.complex = complex;
    return record;
}

TEST(ModelFile, KilledWriterLeavesNoFinalFile) {
    const std::filesystem::path file = fresh_directory("killed") / "m.hdf";
    const int status = status_of_limited_writer(file, large_record(), 100000, true);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ);
    EXPECT_FALSE(std::filesystem::exists(file));
    EXPECT_TRUE(std::filesystem::exists(file.string() + ".tmp"));

    write_model_file(file, sample_record());
    EXPECT_FALSE(std::filesystem::exists(file.string() + ".tmp"));
    EXPECT_EQ(difference(summarize(sample_record()), read_summary(file)), "");
}

TEST(ModelFile, KilledWriterLeavesTheOlderFile) {
    const std::filesystem::path file = fresh_directory("killed_again") / "m.hdf";
    write_model_file(file, sample_record());
    const std::string before = bytes_of(file);
    EXPECT_TRUE(WIFSIGNALED(status_of_limited_writer(file, large_record(), 100000, true)));
    EXPECT_EQ(bytes_of(file), before);
}

TEST(ModelFile, FullDiskIsOneSentenceAndLeavesNothing) {
    const std::filesystem::path directory = fresh_directory("full");
    for (const rlim_t bytes : {0, 100, 2000, 30000, 100000, 1000000}) {
        const int status = status_of_limited_writer(directory / "m.hdf", large_record(), bytes, false);
        EXPECT_TRUE(WIFEXITED(status)) << bytes;
        EXPECT_EQ(WEXITSTATUS(status), 3) << bytes;
        EXPECT_TRUE(std::filesystem::is_empty(directory)) << bytes;
    }
}

/// Runs a script under Debian's own Python, which is where its VTK and h5py are.
int python(const std::string& script, const std::filesystem::path& file) {
    const std::string command = "/usr/bin/python3 -c '" + script + "' '" + file.string() + "' 2>&1";
    return std::system(command.c_str());
}

TEST(ModelFile, VtkOpensIt) {
    if (python("import vtkmodules.vtkIOHDF", "") != 0) GTEST_SKIP() << "python3-vtk9 is not installed";
    const auto file = written(sample_record(), "vtk").file();
    EXPECT_EQ(python(R"py(
import sys, math
from vtkmodules.vtkIOHDF import vtkHDFReader
reader = vtkHDFReader()
assert reader.CanReadFile(sys.argv[1])
reader.SetFileName(sys.argv[1])
reader.Update()
grid = reader.GetOutput()
assert grid.GetNumberOfPoints() == 14 and grid.GetNumberOfCells() == 8, grid
assert [grid.GetCellType(i) for i in range(8)] == [5] * 6 + [4] * 2
assert grid.GetCell(7).GetNumberOfPoints() == 4 and grid.GetCell(7).GetPointId(0) == 10
assert grid.GetPoint(0) == (0, 0, 1 / 3), grid.GetPoint(0)
part = grid.GetCellData().GetArray("part")
assert [part.GetValue(i) for i in range(8)] == [0, 1, 1, 1, 0, 1, 2, 2]
radius = grid.GetPointData().GetArray("MaximumInscribedSphereRadius")
assert math.isnan(radius.GetValue(4)) and radius.GetValue(5) == 0.45
)py",
                     file),
              0);
}

TEST(ModelFile, H5pyReadsTextAndNumbers) {
    if (python("import h5py", "") != 0) GTEST_SKIP() << "python3-h5py is not installed";
    const auto file = written(sample_record(), "h5py").file();
    EXPECT_EQ(python(R"py(
import sys, h5py
f = h5py.File(sys.argv[1], "r")
assert f.attrs["status"] in ("warning", b"warning"), f.attrs["status"]
source = f.attrs["source_file"]
assert (source.decode() if isinstance(source, bytes) else source) == "surfaces/h\u00e9patique.stl"
assert list(f["endpoints/role"].asstr()) == ["inlet", "outlet", "outlet", "outlet"]
assert f["voronoi/arrival_time"][0, 6] == float("inf") and f["voronoi/arrival_time"].dtype == "float32"
assert f["surface/triangles"].dtype == "int32" and f["surface/triangles"].chunks is None
)py",
                     file),
              0);
}

}  // namespace
}  // namespace lumenline
