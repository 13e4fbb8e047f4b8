#include "tests/mutation/trial.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <limits>
#include <thread>

#include "engine/phantom/phantom.h"
#include "io/archive/read.h"
#include "io/mesh/mesh_io.h"
#include "tests/cli/process.h"
#include "tests/mutation/files.h"

namespace lumenline::mutation {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kTimeLimit{60};  // a clean run takes a tenth of a second

// A phantom of few triangles in general position.
TriangleSoup phantom(PhantomKind kind, int around, double size, bool caps = false) {
    PhantomOptions o;
    o.kind = kind;
    o.points_around = around;
    o.a = o.b = 4;
    o.length = size;
    o.leg_length = size;
    o.bend_radius = kind == PhantomKind::kHairpin ? 6 : 15;
    o.arc = 1.5;
    o.jitter = 0.15;
    o.rotate = true;
    o.caps = caps;
    return to_soup(make_phantom(o));
}

std::string point_text(Vec3 p) { return std::to_string(p.x) + "," + std::to_string(p.y) + "," + std::to_string(p.z); }

Subject capped_torus() {
    PhantomOptions o;
    o.kind = PhantomKind::kTorus;
    o.points_around = 14;
    o.a = o.b = 4;
    o.bend_radius = 15;
    o.arc = 1.5;
    o.caps = true;
    const Phantom made = make_phantom(o);
    const double length = made.truth.total_length();
    return {"capped_torus",
            to_soup(made),
            {"--mode", "points", "--inlet=" + point_text(made.truth.position(0.2 * length)),
             "--outlet=" + point_text(made.truth.position(0.8 * length))}};
}

double distance_to(const Line& line, Vec3 p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
        const Vec3 a = line.points[i], d = line.points[i + 1] - a;
        const double t = std::clamp(dot(p - a, d) / std::max(squared_norm(d), 1e-300), 0.0, 1.0);
        least = std::min(least, distance(p, a + t * d));
    }
    return least;
}

double one_way(const Line& from, const Line& to) {
    double largest = 0;
    for (std::size_t i = 0; i < from.points.size(); ++i)
        largest = std::max(largest, distance_to(to, from.points[i]) / from.radius[i]);
    return largest;
}

void read_model(const fs::path& file, Outcome& outcome) {
    const ArchiveFile model(file);
    outcome.verdict = model.attribute("/", "status").value_or("");
    outcome.failure = model.attribute("/", "failure_code").value_or("");
    if (!model.has("/centerlines/points")) return;
    const auto points = model.numbers("/centerlines/points"), radius = model.numbers("/centerlines/radius"),
               offsets = model.numbers("/centerlines/offsets");
    for (std::size_t l = 0; l + 1 < offsets.size(); ++l) {
        Line line;
        for (auto k = static_cast<std::size_t>(offsets[l]); k < static_cast<std::size_t>(offsets[l + 1]); ++k) {
            line.points.push_back({points[3 * k], points[3 * k + 1], points[3 * k + 2]});
            line.radius.push_back(radius[k]);
        }
        outcome.lines.push_back(std::move(line));
    }
}

// A repair moves the wall by a part of an edge near the damage. The subjects' edges are 0.4 to 0.5 radii, and the
// balls of such coarse surfaces move by about half of that when a site is lost or added.
constexpr double kLineTolerance = 0.25;

}  // namespace

const std::vector<Subject>& subjects() {
    static const std::vector<Subject> list = [] {
        const fs::path examples = fs::path(LUMENLINE_SOURCE_DIR) / "examples";
        std::vector<Subject> s;
        s.push_back({"cylinder", phantom(PhantomKind::kCylinder, 14, 25), {}});
        s.push_back({"torus", phantom(PhantomKind::kTorus, 14, 0), {}});
        s.push_back({"helix", phantom(PhantomKind::kHelix, 14, 0), {}});
        s.push_back({"stenosis", phantom(PhantomKind::kStenosis, 16, 30), {}});
        s.push_back({"hairpin", phantom(PhantomKind::kHairpin, 14, 15), {}});
        s.push_back(capped_torus());
        s.push_back({"elliptic_cylinder", read_surface((examples / "phantoms/elliptic_cylinder.ply").string()), {}});
        s.push_back({"gastric_vein",
                     read_surface((examples / "liver/gastric_vein.vtk").string()),
                     {"--mode", "points", "--inlet=27.54,-177.74,-276.02", "--outlet=-27.10,-187.21,-275.55"}});
        return s;
    }();
    return list;
}

Outcome run_model(const std::string& bytes, const std::string& format, const std::vector<std::string>& flags,
                  const fs::path& folder) {
    const fs::path surface = folder / ("surface." + format), result = folder / "model.hdf";
    fs::remove(result);
    cli_test::write_text(surface, bytes);
    std::vector<std::string> argv{LUMENLINE_BINARY, "model", surface.string(), "-o", result.string(), "--threads", "1"};
    argv.insert(argv.end(), flags.begin(), flags.end());
    cli_test::Process child(argv, folder);
    const auto start = std::chrono::steady_clock::now();
    auto pause = std::chrono::milliseconds(2);
    Outcome outcome;
    while (child.running()) {
        if (std::chrono::steady_clock::now() - start > kTimeLimit) {
            child.send(SIGKILL);
            outcome.died = "it was still running after a minute";
        }
        std::this_thread::sleep_for(pause);
        pause = std::min(2 * pause, std::chrono::milliseconds(20));
    }
    const cli_test::Finished finished = child.wait();
    outcome.error = finished.err;
    if (finished.signal != 0 && outcome.died.empty()) outcome.died = "signal " + std::to_string(finished.signal);
    if (!outcome.died.empty()) return outcome;
    outcome.status = finished.status;
    if (fs::exists(result)) read_model(result, outcome);
    return outcome;
}

double deviation(const std::vector<Line>& clean, const std::vector<Line>& other) {
    double largest = 0;
    for (const Line& line : clean) {
        double least = std::numeric_limits<double>::infinity();
        for (const Line& candidate : other)
            least = std::min(least, std::max(one_way(line, candidate), one_way(candidate, line)));
        largest = std::max(largest, least);
    }
    return largest;
}

std::string judge(const Damage& damage, const Outcome& outcome, const std::vector<Line>& clean) {
    if (!outcome.died.empty()) return "WRONG: " + outcome.died + " " + outcome.error;
    if (outcome.status == 1) {
        if (std::count(outcome.error.begin(), outcome.error.end(), '\n') != 1)
            return "WRONG: not one sentence: " + outcome.error;
        return (damage.expected.failures.contains(outcome.failure) ? "refused: " : "WRONG: refused: ") +
               outcome.failure + (damage.expected.failures.contains(outcome.failure) ? "" : " " + outcome.error);
    }
    if (outcome.status != 0) return "WRONG: exit status " + std::to_string(outcome.status) + " " + outcome.error;
    const double off = deviation(clean, outcome.lines);
    if (damage.expected.repaired && off <= kLineTolerance) return "repaired";
    if (damage.expected.other_lines && outcome.verdict == "warning") return "other lines";
    return "WRONG: " + outcome.verdict + ", lines off by " + std::to_string(off) + " radii";
}

std::string try_damage(std::size_t s, std::size_t d, const std::vector<Line>& clean, const fs::path& folder) {
    const Damage& damage = all_damages()[d];
    std::mt19937 random(static_cast<std::uint32_t>(1000 * s + d));
    const std::string bytes = damage.make(subjects()[s].soup, random);
    return judge(damage, run_model(bytes, damage.format, subjects()[s].flags, folder), clean);
}

std::vector<Line> clean_lines(std::size_t s, const fs::path& folder) {
    return run_model(file_of(subjects()[s].soup, "ply"), "ply", subjects()[s].flags, folder).lines;
}

}  // namespace lumenline::mutation
