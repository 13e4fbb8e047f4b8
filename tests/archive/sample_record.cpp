// The values are arbitrary but exact in no short decimal (thirds, sevenths), so that a loss of
// precision anywhere shows.

#include "tests/archive/sample_record.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <type_traits>

#include "engine/core/branch_tables.h"
#include "io/archive/index.h"
#include "io/archive/model_file.h"

namespace lumenline {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::shared_ptr<const Surface> sample_surface() {
    auto surface = std::make_shared<Surface>();
    surface->points = {{0, 0, 1.0 / 3}, {1, 0, 0}, {-0.5, 0.866, 0}, {-0.5, -0.866, 0}, {0, 0, -1.0 / 7}};
    for (const auto& [a, b, c] : {std::array{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {4, 2, 1}, {4, 3, 2}, {4, 1, 3}})
        surface->triangles.push_back({SiteId(static_cast<std::size_t>(a)), SiteId(static_cast<std::size_t>(b)),
                                      SiteId(static_cast<std::size_t>(c))});
    for (const Vec3& p : surface->points) surface->normals.push_back(normalized(p));
    surface->input_vertex = {0, 1, 2, SiteId::kNoneValue, SiteId::kNoneValue};
    surface->origin = {SiteOrigin::kWall, SiteOrigin::kWall, SiteOrigin::kWall, SiteOrigin::kExtension,
                       SiteOrigin::kCap};
    surface->cap = {OpeningId(), OpeningId(0), OpeningId(1), OpeningId(2), OpeningId(), OpeningId(1)};
    surface->openings.resize(3);
    surface->diagonal = 2.0 / 3;
    surface->median_edge = 1.0 / 7;
    surface->coordinate_rounding = 1e-8;
    surface->genus = 1;
    return surface;
}

std::shared_ptr<const VoronoiComplex> sample_complex() {
    auto complex = std::make_shared<VoronoiComplex>();
    for (int i = 0; i < 7; ++i) {
        complex->vertices.push_back({i / 7.0, i / 9.0, -i / 3.0});
        complex->ball_radius.push_back(0.1 + i / 11.0);
        complex->vertex_site.emplace_back(static_cast<std::size_t>(i % 5));
    }
    complex->polygon_offsets = {0, 4, 6, 9};
    for (const std::size_t v : {0, 1, 2, 3, 3, 4, 4, 5, 6}) complex->polygon_vertices.emplace_back(v);
    complex->polygon_sites = {{SiteId(0), SiteId(1)}, {SiteId(), SiteId()}, {SiteId(2), SiteId(3)}};
    complex->pole = {VoronoiVertexId(0), VoronoiVertexId(3), VoronoiVertexId(), VoronoiVertexId(6), VoronoiVertexId(2)};
    return complex;
}

std::shared_ptr<const Endpoints> sample_endpoints() {
    auto endpoints = std::make_shared<Endpoints>(4);
    for (std::size_t e = 0; e < endpoints->size(); ++e) {
        Endpoint& endpoint = (*endpoints)[e];
        endpoint.point = {e / 3.0, 1, 2};
        endpoint.normal = {0, 0, 1};
        endpoint.radius = 0.3 + e / 7.0;
        endpoint.anchor = {e / 9.0, 1, 2};
        endpoint.anchor_radius = 0.2;
    }
    // The second opening is the first endpoint; the third opening is none.
    (*endpoints)[0].opening = OpeningId(1);
    (*endpoints)[0].role = EndpointRole::kInlet;
    (*endpoints)[1].opening = OpeningId(0);
    for (const std::size_t given : {2, 3}) {
        (*endpoints)[given].kind = EndpointKind::kPoint;
        (*endpoints)[given].normal = {};
    }
    return endpoints;
}

std::shared_ptr<const ArrivalField> sample_field(std::size_t source, double unreached) {
    auto field = std::make_shared<ArrivalField>();
    field->source = EndpointId(source);
    field->time = {0, 1.0 / 3, 2.0 / 3, 1, 4.0 / 3, 5.0 / 3, unreached};
    field->reached = unreached == kInfinity ? 6 : 7;
    field->residual = 1e-9;
    return field;
}

std::shared_ptr<const Centerlines> sample_lines() {
    auto lines = std::make_shared<Centerlines>();
    lines->offsets = {0, 5, 9};
    for (int k = 0; k < 9; ++k) {
        const int along = k < 5 ? k : k - 5;
        lines->points.push_back({along / 3.0, 0, 0});
        lines->abscissa.push_back(along / 3.0);
        lines->ball_radius.push_back(0.5 + k / 7.0);
        lines->clearance.push_back(0.4 + k / 7.0);
        lines->radius.push_back(0.45 + k / 7.0);
        lines->radius_error.push_back(0.05 + k / 70.0);
        lines->position_error.push_back(k == 3 ? std::numeric_limits<double>::quiet_NaN() : 0.01 + k / 70.0);
    }
    lines->source = {EndpointId(0), EndpointId(0)};
    lines->target = {EndpointId(1), EndpointId(3)};
    lines->loop.resize(2);
    lines->loops = {{EndpointId(1), {0.25, 0.5, 0.75}, 0.125, 3.5}};
    lines->path.offsets = {0, 6, 11};
    for (int q = 0; q < 11; ++q) {
        const int along = q < 6 ? q : q - 6;
        lines->path.points.push_back({along / 4.0, 0, 0});
        lines->path.ball_radius.push_back(0.5);
        lines->path.abscissa.push_back(along / 4.0);
        lines->path.line_abscissa.push_back(along / 4.1);
    }
    return lines;
}

std::shared_ptr<const SurfaceCharacter> sample_character() {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    auto character = std::make_shared<SurfaceCharacter>();
    character->centerline_distance = {0, 1.0 / 7, 2.0 / 7, 3.0 / 7, 4.0 / 7, 5.0 / 7, kInfinity};
    character->geodesic_distance = {1.0 / 3, 2.0 / 3, 1, 4.0 / 3, kNaN};
    character->descent_length = {0.1, 0.2, 0.3, 0.4, kNaN};
    character->euclidean_distance = {0.3, 0.6, 0.9, 1.2, kNaN};
    character->normalized_tangency_deviation = {0, 0.1, 0.2, 1, kNaN};
    character->geodesic_distance_refined = {0.31, 0.61, 0.91, 1.21, kNaN};
    character->normalized_tangency_deviation_refined = {0.01, 0.11, 0.21, 0.99, kNaN};
    character->centerline_point = {{0, 0, 0}, {1.0 / 3, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {kNaN, kNaN, kNaN}};
    character->centerline_id = {LineId(0), LineId(0), LineId(1), LineId(1), LineId()};
    character->abscissa = {0, 1.0 / 3, 0.5, 1, kNaN};
    character->zone = {SiteZone::kWall, SiteZone::kWall, SiteZone::kAdded, SiteZone::kEndZone, SiteZone::kWall};
    character->wall_sites = 3;
    character->unreached = 1;
    character->not_refined = 2;
    character->geodesic_distance_statistics = {0.5, 1.0 / 6, 0.4, 2.0 / 3};
    character->euclidean_distance_statistics = {0.45, 0.15, 0.35, 0.6};
    character->normalized_tangency_deviation_statistics = {0.05, 0.04, 0.06, 0.1};
    character->jumps = {3, 4, 5};
    return character;
}

/// Thirds that differ from column to column, with a missing value.
class Filler {
public:
    void operator()(std::vector<double>& column, std::size_t rows) {
        for (std::size_t k = 0; k < rows; ++k) column.push_back(next_++ / 3.0);
        column.back() = std::numeric_limits<double>::quiet_NaN();
    }
    void operator()(std::vector<Vec3>& column, std::size_t rows) {
        for (std::size_t k = 0; k < rows; ++k) column.push_back({next_++ / 3.0, next_++ / 7.0, next_++ / 9.0});
    }
    void operator()(std::vector<Distribution>& column, std::size_t rows) {
        for (std::size_t k = 0; k < rows; ++k)
            column.push_back({next_++ / 3.0, 0.1, 0.2, 0.3, 0.4, next_++ / 7.0, 0.6, 0.7, 0.8});
    }
    template <class T>
    requires(!std::is_floating_point_v<T>) void operator()(std::vector<T>& column, std::size_t rows) {
        for (std::size_t k = 0; k < rows; ++k) column.push_back(T(static_cast<std::uint8_t>(k)));
    }
    /// Several columns of one length.
    template <class... Columns>
    void all(std::size_t rows, Columns&... columns) {
        ((*this)(columns, rows), ...);
    }

private:
    int next_ = 1;
};

void fill_tables(Branches& b, Filler& fill) {
    BranchTable& t = b.table;
    fill.all(3, t.parent, t.generation, t.line_count, t.order_margin, t.length, t.own_length, t.chord,
             t.length_over_chord, t.tortuosity, t.taper, t.radius, t.area, t.curvature, t.torsion, t.wall_area,
             t.volume, t.geodesic_distance, t.euclidean_distance, t.normalized_tangency_deviation);
    t.parent[0] = BranchId();
    SectionTable& s = b.sections;
    fill.all(5, s.branch, s.abscissa, s.relative, s.point, s.normal, s.area, s.perimeter, s.equivalent_diameter,
             s.hydraulic_diameter, s.min_diameter, s.max_diameter, s.min_projection, s.inscribed_diameter,
             s.circularity, s.centroid_offset, s.closed);
    BifurcationTable& j = b.bifurcations;
    fill.all(1, j.node, j.parent, j.child_1, j.child_2, j.children, j.origin, j.normal, j.angle_1, j.angle_2,
             j.angle_between, j.in_plane_1, j.in_plane_2, j.out_of_plane_parent, j.out_of_plane_1, j.out_of_plane_2,
             j.planarity, j.parent_diameter, j.diameter_1, j.diameter_2, j.area_ratio, j.diameter_ratio_1,
             j.diameter_ratio_2, j.asymmetry, j.murray_exponent);
    ChildTable& c = b.children;
    fill.all(2, c.junction, c.parent, c.child, c.at_last_node, c.angle, c.in_plane, c.out_of_plane, c.diameter,
             c.diameter_ratio, c.share);
    StenosisTable& n = b.stenoses;
    fill.all(3, n.abscissa, n.diameter, n.area, n.nascet_diameter, n.nascet_area, n.ecst_diameter, n.ecst_area,
             n.distal_reference, n.fitted_reference, n.from, n.to, n.length);
    DilationTable& d = b.dilations;
    fill.all(3, d.abscissa, d.diameter, d.fitted_reference, d.ratio, d.area_ratio, d.from, d.to, d.length);
    PatchTable& p = b.patches;
    fill.all(8, p.branch, p.along, p.around, p.sites, p.area, p.distance, p.geodesic_distance, p.euclidean_distance,
             p.normalized_tangency_deviation);
}

std::shared_ptr<const Branches> sample_branches() {
    auto branches = std::make_shared<Branches>();
    Branches& b = *branches;
    Filler fill;
    fill.all(4, b.graph.position, b.graph.radius);
    b.graph.endpoint = {EndpointId(0), EndpointId(), EndpointId(1), EndpointId(3)};
    b.graph.junction = {JunctionId(), JunctionId(0), JunctionId(), JunctionId()};
    b.graph.edges = {{NodeId(0), NodeId(1)}, {NodeId(1), NodeId(2)}, {NodeId(1), NodeId(3)}};
    b.lines.offsets = {0, 2, 5, 7};
    fill.all(7, b.lines.points, b.lines.radius, b.lines.abscissa, b.lines.curvature, b.lines.torsion, b.lines.tangent,
             b.lines.normal, b.lines.frame);
    fill.all(3, b.lines.own_from, b.lines.own_to);
    fill.all(9, b.points.branch, b.points.junction, b.points.branch_abscissa, b.points.curvature, b.points.torsion,
             b.points.tangent, b.points.frame);
    for (std::size_t k = 0; k < 9; ++k) b.points.branch[k] = BranchId(k % 3);
    fill.all(5, b.surface.branch, b.surface.junction, b.surface.longitudinal, b.surface.relative, b.surface.angle);
    b.surface.branch.back() = BranchId();
    fill_tables(b, fill);
    return branches;
}

}  // namespace

ModelRecord sample_record(const std::string& id) {
    ModelRecord record;
    ModelIdentity& who = record.identity;
    who.id = id;
    who.subject = "sub-01";
    who.session = "ses-2";
    who.side = "L";
    who.structure = "aorta";
    who.group = "control";
    who.length_unit = "mm";
    who.coordinate_system = "LPS";
    who.source_file = "surfaces/h\xC3\xA9patique.stl";
    who.source_sha256 = std::string(64, 'a');
    who.inputs_sha256 = std::string(64, 'b');
    who.covariates = {{"age", "63"}, {"sex", "f"}, {"height/m", "1.7"}};
    record.status = ModelStatus::kWarning;
    record.diagnostics = {{"coarse", Severity::kWarning, Stage::kCondition, "the wall is coarse", 1.0 / 3, 0.25},
                          {"seen", Severity::kNote, Stage::kTrace, "a note"}};
    record.surface = sample_surface();
    record.complex = sample_complex();
    record.endpoints = sample_endpoints();
    record.fields = {sample_field(0, kInfinity), sample_field(2, 2)};
    record.centerlines = sample_lines();
    record.character = sample_character();
    record.branches = sample_branches();
    record.facts.stage_seconds = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.2, 0.1, 0.4};
    record.facts.total_seconds = 2.8;
    record.facts.peak_resident_bytes = 123456789;
    record.facts.threads = 2;
    return record;
}

ModelRecord failed_record(const std::string& id) {
    ModelRecord record = sample_record(id);
    record.status = ModelStatus::kFailed;
    record.failure = Failure{Stage::kEikonal, ErrorCode::kNoSeed, "a front needs at least one vertex to start from"};
    record.endpoints = nullptr;
    record.fields = {nullptr};
    record.centerlines = nullptr;
    record.character = nullptr;
    record.branches = nullptr;
    return record;
}

std::filesystem::path sample_archive(const std::vector<ModelRecord>& records, const std::string& name) {
    std::filesystem::path directory = fresh_directory(name);
    std::filesystem::create_directory(directory / "models");
    std::vector<ModelSummary> models;
    for (const ModelRecord& record : records) {
        write_model_file(model_path(directory, record.identity.id), record);
        models.push_back(summarize(record));
    }
    write_index(directory, models, "cohort: a\n", "cohort: a\nlength_unit: mm\n");
    return directory;
}

std::filesystem::path fresh_directory(const std::string& name) {
    // Tests run beside each other: each has its own.
    const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
    const std::string owner = test == nullptr ? "" : std::string(test->test_suite_name()) + "_" + test->name() + "_";
    std::filesystem::path directory =
        std::filesystem::path(::testing::TempDir()) / ("lumenline_archive_" + owner + name);
    std::filesystem::remove_all(directory);
    std::filesystem::create_directories(directory);
    return directory;
}

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    return bytes.str();
}

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

void expect_same(const std::vector<double>& a, const std::vector<double>& b, const std::string& what) {
    ASSERT_EQ(a.size(), b.size()) << what;
    for (std::size_t k = 0; k < a.size(); ++k)
        EXPECT_TRUE(a[k] == b[k] || (std::isnan(a[k]) && std::isnan(b[k]))) << what << " " << k;
}

std::string difference(const ModelSummary& a, const ModelSummary& b) {
    const ModelIdentity& p = a.identity;
    const ModelIdentity& q = b.identity;
    if (p.id != q.id) return "id";
    if (p.subject != q.subject || p.session != q.session || p.side != q.side) return "subject, session or side";
    if (p.structure != q.structure || p.group != q.group) return "structure or group";
    if (p.length_unit != q.length_unit || p.coordinate_system != q.coordinate_system) return "unit or system";
    if (p.source_file != q.source_file || p.source_sha256 != q.source_sha256) return "source";
    if (p.inputs_sha256 != q.inputs_sha256) return "inputs_sha256";
    if (p.covariates != q.covariates) return "covariates";
    if (a.status != b.status) return "status";
    if (a.failure.has_value() != b.failure.has_value()) return "failure";
    if (a.failure && (a.failure->stage != b.failure->stage || a.failure->code != b.failure->code)) return "failure";
    if (a.failure && a.failure->sentence != b.failure->sentence) return "sentence";
    if (a.warnings != b.warnings) return "warnings";
    if (a.sites != b.sites || a.triangles != b.triangles) return "sites or triangles";
    if (a.voronoi_vertices != b.voronoi_vertices || a.polygons != b.polygons) return "vertices or polygons";
    if (a.inlets != b.inlets || a.outlets != b.outlets || a.centerlines != b.centerlines) return "endpoints or lines";
    if (a.length != b.length) return "length";
    if (a.radius_min != b.radius_min || a.radius_max != b.radius_max) return "least or largest radius";
    if (a.radius_mean != b.radius_mean) return "mean radius";
    const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
    const auto differ = [&](const AreaStatistics& x, const AreaStatistics& y) {
        return !(same(x.mean, y.mean) && same(x.sd, y.sd) && same(x.median, y.median) && same(x.p95, y.p95));
    };
    if (differ(a.geodesic_distance, b.geodesic_distance)) return "geodesic distance";
    if (differ(a.euclidean_distance, b.euclidean_distance)) return "euclidean distance";
    if (differ(a.normalized_tangency_deviation, b.normalized_tangency_deviation)) return "tangency deviation";
    if (a.genus != b.genus || a.loops != b.loops) return "genus or loops";
    if (a.unreached_sites != b.unreached_sites) return "unreached sites";
    return a.seconds == b.seconds ? "" : "seconds";
}

}  // namespace lumenline
