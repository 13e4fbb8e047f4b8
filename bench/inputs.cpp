// Phantoms are cylinders of elliptic section 3/5 with jittered vertices: structured meshes are
// cospherical throughout, and the Delaunay triangulation of them costs several times as much.
#include "bench/inputs.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>
#include <stdexcept>
#include <string_view>

#include "bench/subdivide.h"
#include "config/cohort.h"
#include "io/mesh/mesh_io.h"

namespace lumenline::bench {

namespace {

struct Cylinder {
    std::string_view name;
    int points_around;
    bool large;
};
constexpr std::array<Cylinder, 5> kCylinders{{{"cylinder_3k", 32, false},
                                              {"cylinder_12k", 64, false},
                                              {"cylinder_50k", 130, false},
                                              {"cylinder_200k", 260, true},
                                              {"cylinder_400k", 368, true}}};
constexpr std::array<std::string_view, 4> kExamples{"gastric_vein", "arteries", "portal_vein", "arch_to_willis"};

Input make_cylinder(const Cylinder& cylinder) {
    PhantomOptions options;
    options.a = 5;
    options.b = 3;
    options.points_around = cylinder.points_around;
    options.jitter = 0.2;
    options.rotate = true;
    const Phantom phantom = make_phantom(options);
    return {std::string(cylinder.name), to_soup(phantom), {}, phantom.truth, phantom.edge_length};
}

Input read_example(std::string_view name) {
    for (const ModelTask& task : load_cohort(LUMENLINE_EXAMPLES "/cohort.yaml").tasks)
        if (task.identity.id == name)
            return {std::string(name), read_surface(task.surface_path), task.options, std::nullopt, 0};
    throw std::runtime_error("examples/participants.tsv has no model '" + std::string(name) + "'");
}

Input read_input(const std::string& name) {
    for (const Cylinder& cylinder : kCylinders)
        if (cylinder.name == name) return make_cylinder(cylinder);
    if (std::find(kExamples.begin(), kExamples.end(), name) != kExamples.end()) return read_example(name);
    return {name.substr(name.rfind('/') + 1), read_surface(name), {}, std::nullopt, 0};
}

int subdivisions() {
    const char* text = std::getenv("LUMENLINE_BENCH_SUBDIVIDE");
    if (text == nullptr) return 0;
    const std::string_view digits(text);
    if (digits.size() != 1 || digits[0] < '0' || digits[0] > '3')
        throw std::runtime_error("LUMENLINE_BENCH_SUBDIVIDE must be 0, 1, 2 or 3, not '" + std::string(digits) + "'");
    return digits[0] - '0';
}

}  // namespace

std::vector<std::string> known_inputs() {
    std::vector<std::string> names;
    for (const Cylinder& cylinder : kCylinders) names.emplace_back(cylinder.name);
    for (const std::string_view name : kExamples) names.emplace_back(name);
    return names;
}

std::vector<std::string> default_inputs() {
    if (const char* path = std::getenv("LUMENLINE_BENCH_SURFACE")) return {path};
    std::vector<std::string> names = known_inputs();
    if (std::getenv("LUMENLINE_BENCH_LARGE") == nullptr)
        for (const Cylinder& cylinder : kCylinders)
            if (cylinder.large) std::erase(names, cylinder.name);
    return names;
}

Input find_input(const std::string& name) {
    Input input = read_input(name);
    if (const int levels = subdivisions(); levels > 0) {
        input.soup = loop_subdivided(input.soup, levels);
        input.name += "_subdivided_" + std::to_string(levels);
        input.truth.reset();
    }
    return input;
}

TriangleSoup jittered(const TriangleSoup& soup, std::uint64_t seed) {
    double sum = 0;
    for (const auto& t : soup.triangles) sum += distance(soup.points[t[0]], soup.points[t[1]]);
    const double most = 1e-3 * sum / static_cast<double>(soup.triangles.size());
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> offset(-most, most);
    TriangleSoup copy = soup;
    for (Vec3& p : copy.points)
        for (int axis = 0; axis < 3; ++axis) p[axis] += offset(random);
    return copy;
}

}  // namespace lumenline::bench
