// Damage to triangles is written in a format of the damage's own, so that all formats are met; damage to bytes is done
// in every format. Numbers in text keep 17 digits: only the damage differs from the clean surface.
#include "tests/mutation/damage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <utility>

#include "tests/mutation/files.h"

namespace lumenline::mutation {
namespace {

using Random = std::mt19937;
using Edit = std::function<void(TriangleSoup&, Random&)>;

const std::set<std::string> kBroken{"file_format", "no_surface", "bad_coordinate"};

double edge_of(const TriangleSoup& s, std::size_t t) {
    return distance(s.points[s.triangles[t][0]], s.points[s.triangles[t][1]]);
}

Vec3 normal_of(const TriangleSoup& s, std::size_t t) {
    const auto& c = s.triangles[t];
    return normalized(cross(s.points[c[1]] - s.points[c[0]], s.points[c[2]] - s.points[c[0]]));
}

Vec3 middle_of(const TriangleSoup& s, std::size_t t) {
    const auto& c = s.triangles[t];
    return (1.0 / 3) * (s.points[c[0]] + s.points[c[1]] + s.points[c[2]]);
}

double diagonal_of(const TriangleSoup& s) {
    Vec3 low = s.points[0], high = low;
    for (const Vec3& p : s.points)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    return distance(low, high);
}

std::size_t pick(const TriangleSoup& s, Random& random) { return random() % s.triangles.size(); }

void flip(TriangleSoup& s, std::size_t t) { std::swap(s.triangles[t][1], s.triangles[t][2]); }

void flip_share(TriangleSoup& s, Random& random, unsigned one_in) {
    for (std::size_t t = 0; t < s.triangles.size(); ++t)
        if (random() % one_in == 0) flip(s, t);
}

void drop(TriangleSoup& s, Random& random, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
        s.triangles.erase(s.triangles.begin() + static_cast<std::ptrdiff_t>(pick(s, random)));
}

void explode(TriangleSoup& s, Random& random, double noise) {
    TriangleSoup loose;
    const double size = noise * diagonal_of(s);
    std::uniform_real_distribution<double> shift(-size, size);
    for (const auto& t : s.triangles) {
        const auto first = static_cast<std::uint32_t>(loose.points.size());
        for (const std::uint32_t v : t)
            loose.points.push_back(s.points[v] + Vec3{shift(random), shift(random), shift(random)});
        loose.triangles.push_back({first, first + 1, first + 2});
    }
    s = std::move(loose);
}

void add(TriangleSoup& s, const TriangleSoup& other) {
    const auto shift = static_cast<std::uint32_t>(s.points.size());
    s.points.insert(s.points.end(), other.points.begin(), other.points.end());
    for (const auto& t : other.triangles) s.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
}

TriangleSoup tetrahedron(Vec3 centre, double size) {
    TriangleSoup s;
    for (const Vec3 d : {Vec3{1, 1, 1}, Vec3{1, -1, -1}, Vec3{-1, 1, -1}, Vec3{-1, -1, 1}})
        s.points.push_back(centre + size * d);
    s.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    return s;
}

void add_fin(TriangleSoup& s, Random& random, double height) {
    const std::size_t t = pick(s, random);
    const auto c = s.triangles[t];
    s.points.push_back(lerp(s.points[c[0]], s.points[c[1]], 0.5) + height * edge_of(s, t) * normal_of(s, t));
    s.triangles.push_back({c[0], c[1], static_cast<std::uint32_t>(s.points.size() - 1)});
}

void weld_corner(TriangleSoup& s, std::uint32_t from, std::uint32_t to) {
    for (auto& t : s.triangles) std::replace(t.begin(), t.end(), from, to);
}

void set_coordinate(TriangleSoup& s, Random& random, double value) {
    s.points[s.triangles[pick(s, random)][0]][static_cast<int>(random() % 3)] = value;
}

// A vertex that two of the triangles around an edge's middle know, and the third does not.
void hang_a_vertex(TriangleSoup& s, Random& random) {
    const std::size_t t = pick(s, random);
    const auto c = s.triangles[t];
    s.points.push_back(lerp(s.points[c[0]], s.points[c[1]], 0.5));
    const auto m = static_cast<std::uint32_t>(s.points.size() - 1);
    s.triangles[t] = {m, c[1], c[2]};
    s.triangles.push_back({c[0], m, c[2]});
}

void drop_fan(TriangleSoup& s, Random& random) {
    const std::uint32_t v = s.triangles[pick(s, random)][0];
    std::erase_if(s.triangles, [=](const auto& t) { return std::find(t.begin(), t.end(), v) != t.end(); });
}

// A seam: the triangles on one side of a few edges get vertices of their own, moved by `gap` edges.
void open_seam(TriangleSoup& s, Random& random, double gap) {
    const std::size_t t = pick(s, random);
    const std::uint32_t v = s.triangles[t][0];
    s.points.push_back(s.points[v] + gap * edge_of(s, t) * normal_of(s, t));
    s.triangles[t][0] = static_cast<std::uint32_t>(s.points.size() - 1);
}

void move_vertex(TriangleSoup& s, Random& random, double edges) {
    const std::size_t t = pick(s, random);
    s.points[s.triangles[t][0]] += edges * edge_of(s, t) * normal_of(s, t);
}

void roughen(TriangleSoup& s, Random& random) {
    std::uniform_real_distribution<double> shift(-0.05, 0.05);
    for (std::size_t t = 0; t < s.triangles.size(); ++t)
        s.points[s.triangles[t][0]] += (shift(random) / 3 * edge_of(s, t)) * normal_of(s, t);
}

void shuffle(TriangleSoup& s, Random& random) {
    std::shuffle(s.triangles.begin(), s.triangles.end(), random);
    for (auto& t : s.triangles) std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(random() % 3), t.end());
}

TriangleSoup sheet(std::uint32_t n) {
    TriangleSoup s;
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t j = 0; j <= n; ++j) s.points.push_back({1.0 * i, 1.0 * j, 0});
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
            s.triangles.push_back({a, b, b + 1});
            s.triangles.push_back({a, b + 1, a + 1});
        }
    return s;
}

TriangleSoup moebius_strip() {
    constexpr std::uint32_t n = 60, w = 12;
    TriangleSoup s;
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j <= w; ++j) {
            const double a = 2 * std::numbers::pi * i / n, q = 2.0 * j / w - 1, r = 5 + q * std::cos(a / 2);
            s.points.push_back({r * std::cos(a), r * std::sin(a), q * std::sin(a / 2)});
        }
    const auto id = [](std::uint32_t i, std::uint32_t j) { return i < n ? i * (w + 1) + j : w - j; };
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < w; ++j) {
            s.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
            s.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
        }
    return s;
}

// A tube around a figure of eight that passes through itself in the middle.
TriangleSoup crossing_tube() {
    constexpr std::uint32_t around = 12, rings = 81;
    TriangleSoup s;
    for (std::uint32_t k = 0; k < rings; ++k) {
        const double u = std::numbers::pi * (2.0 * k / (rings - 1) - 1) * 0.9;
        const Vec3 centre{8 * std::sin(u), 8 * std::sin(u) * std::cos(u), 0};
        const Vec3 tangent = normalized({std::cos(u), std::cos(2 * u), 0});
        const Vec3 side = cross(tangent, {0, 0, 1});
        for (std::uint32_t i = 0; i < around; ++i) {
            const double a = 2 * std::numbers::pi * i / around;
            s.points.push_back(centre + std::cos(a) * side + std::sin(a) * Vec3{0, 0, 1});
        }
    }
    for (std::uint32_t k = 0; k + 1 < rings; ++k)
        for (std::uint32_t i = 0; i < around; ++i) {
            const std::uint32_t a = k * around + i, b = k * around + (i + 1) % around;
            s.triangles.push_back({a, b, a + around});
            s.triangles.push_back({b, b + around, a + around});
        }
    return s;
}

Damage edited(const char* name, const char* format, Expected expected, Edit edit) {
    return {name, format, std::move(expected), [format, edit](const TriangleSoup& clean, Random& random) {
                TriangleSoup soup = clean;
                edit(soup, random);
                return file_of(soup, format);
            }};
}

Damage shape(const char* name, const char* format, Expected expected, TriangleSoup (*make)()) {
    return {name, format, std::move(expected),
            [format, make](const TriangleSoup&, Random&) { return file_of(make(), format); }};
}

void add_face_damages(std::vector<Damage>& list) {
    const Expected mended{true, false, {}};
    list.push_back(edited("faces repeated", "stl", mended, [](TriangleSoup& s, Random& r) {
        for (int i = 0; i < 50; ++i) s.triangles.push_back(s.triangles[pick(s, r)]);
    }));
    list.push_back(edited("faces repeated and turned", "ply", mended, [](TriangleSoup& s, Random& r) {
        for (int i = 0; i < 50; ++i) {
            s.triangles.push_back(s.triangles[pick(s, r)]);
            flip(s, s.triangles.size() - 1);
        }
    }));
    list.push_back(edited("one face dropped", "obj", mended, [](TriangleSoup& s, Random& r) { drop(s, r, 1); }));
    list.push_back(edited("five faces dropped", "off", mended, [](TriangleSoup& s, Random& r) { drop(s, r, 5); }));
    list.push_back(edited("a fiftieth of the faces dropped", "vtk", {true, true, {"open_boundary"}},
                          [](TriangleSoup& s, Random& r) { drop(s, r, s.triangles.size() / 50); }));
    list.push_back(edited("half of the faces dropped", "stl",
                          {false, false, {"open_boundary", "non_manifold", "not_closed", "no_surface"}},
                          [](TriangleSoup& s, Random& r) { drop(s, r, s.triangles.size() / 2); }));
    list.push_back(edited("all faces around a vertex dropped", "ply", mended, drop_fan));
    list.push_back(
        edited("a tenth of the faces turned", "stl", mended, [](TriangleSoup& s, Random& r) { flip_share(s, r, 10); }));
    list.push_back(
        edited("half of the faces turned", "obj", mended, [](TriangleSoup& s, Random& r) { flip_share(s, r, 2); }));
    list.push_back(edited("all faces turned", "off", mended, [](TriangleSoup& s, Random& r) { flip_share(s, r, 1); }));
    list.push_back(edited("faces without area", "vtk", mended, [](TriangleSoup& s, Random& r) {
        for (int i = 0; i < 20; ++i) {
            const auto c = s.triangles[pick(s, r)];
            s.triangles.push_back({c[0], c[0], c[1]});
        }
    }));
    list.push_back(edited("fins without area", "ply", mended, [](TriangleSoup& s, Random& r) { add_fin(s, r, 0); }));
    list.push_back(edited("fins", "obj", mended, [](TriangleSoup& s, Random& r) {
        for (int i = 0; i < 3; ++i) add_fin(s, r, 0.7);
    }));
    list.push_back(edited("order shuffled", "off", mended, shuffle));
    list.push_back(edited("vertex on an edge of one face only", "ply", mended, hang_a_vertex));
}

void add_vertex_damages(std::vector<Damage>& list) {
    const Expected mended{true, false, {}};
    const Expected refused{false, false, {"bad_coordinate", "file_format"}};
    list.push_back(edited("each face on its own", "stl", mended, [](TriangleSoup& s, Random& r) { explode(s, r, 0); }));
    list.push_back(edited("each face on its own, roughly", "ply", mended,
                          [](TriangleSoup& s, Random& r) { explode(s, r, 1e-9); }));
    list.push_back(edited("each face on its own, torn apart", "obj", {false, false, {"open_boundary"}},
                          [](TriangleSoup& s, Random& r) { explode(s, r, 1e-3); }));
    list.push_back(edited("neighbours merged", "off", mended, [](TriangleSoup& s, Random& r) {
        const auto c = s.triangles[pick(s, r)];
        weld_corner(s, c[0], c[1]);
    }));
    list.push_back(edited(
        "vertices far apart merged", "vtk", {true, true, {"non_manifold", "open_boundary", "not_closed", "no_volume"}},
        [](TriangleSoup& s, Random& r) { weld_corner(s, s.triangles[pick(s, r)][0], s.triangles[pick(s, r)][0]); }));
    list.push_back(
        edited("corner torn off by a hair", "ply", mended, [](TriangleSoup& s, Random& r) { open_seam(s, r, 1e-9); }));
    list.push_back(edited("corner torn off", "obj", {true, true, {"open_boundary", "non_manifold"}},
                          [](TriangleSoup& s, Random& r) { open_seam(s, r, 0.3); }));
    list.push_back(edited("vertex pulled out", "off", {true, true, {}},
                          [](TriangleSoup& s, Random& r) { move_vertex(s, r, 1.5); }));
    list.push_back(edited("vertex pushed through the opposite wall", "vtk",
                          {true, true, {"non_manifold", "open_boundary", "target_unreached", "no_line_traced"}},
                          [](TriangleSoup& s, Random& r) { move_vertex(s, r, -8); }));
    list.push_back(edited("rough", "ply", mended, roughen));
    list.push_back(edited("vertices that no face uses", "ply", mended, [](TriangleSoup& s, Random&) {
        s.points.insert(s.points.end(), 100, Vec3{1e6, -1e6, 1e7});
    }));
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const char* format : {"obj", "off", "ply"}) {
        list.push_back(edited("coordinate not a number", format, refused, [](TriangleSoup& s, Random& r) {
            set_coordinate(s, r, std::numeric_limits<double>::quiet_NaN());
        }));
        list.push_back(edited("coordinate infinite", format, refused,
                              [](TriangleSoup& s, Random& r) { set_coordinate(s, r, kInfinity); }));
        list.push_back(edited("coordinate of 1e21", format, {false, false, {"bad_coordinate"}},
                              [](TriangleSoup& s, Random& r) { set_coordinate(s, r, 1e21); }));
        list.push_back(edited("coordinate of 1e300", format, {false, false, {"bad_coordinate"}},
                              [](TriangleSoup& s, Random& r) { set_coordinate(s, r, -1e300); }));
    }
    list.push_back(edited("coordinate of 1e18", "ply", {false, false, {"no_surface", "open_boundary", "no_volume"}},
                          [](TriangleSoup& s, Random& r) { set_coordinate(s, r, 1e18); }));
}

void add_whole_shapes(std::vector<Damage>& list) {
    list.push_back(edited("a second component", "stl", {true, false, {}}, [](TriangleSoup& s, Random&) {
        TriangleSoup copy = s;
        for (Vec3& p : copy.points) p.x += 3 * diagonal_of(s);
        add(s, copy);
    }));
    list.push_back(edited("a speck beside it", "ply", {true, false, {}}, [](TriangleSoup& s, Random&) {
        const double size = diagonal_of(s);
        add(s, tetrahedron(s.points[0] + Vec3{2 * size, 0, 0}, 0.002 * size));
    }));
    list.push_back(
        edited("a component inside", "obj", {true, true, {"nested_components"}}, [](TriangleSoup& s, Random& r) {
            const std::size_t t = pick(s, r);
            add(s, tetrahedron(middle_of(s, t) - 2 * edge_of(s, t) * normal_of(s, t), 0.3 * edge_of(s, t)));
        }));
    list.push_back(
        edited("no faces", "off", {false, false, kBroken}, [](TriangleSoup& s, Random&) { s.triangles.clear(); }));
    const Expected nothing{false, false, {"open_boundary", "no_volume", "no_surface"}};
    list.push_back(shape("a plane", "ply", nothing, [] { return sheet(20); }));
    list.push_back(shape("one triangle", "stl", nothing, [] {
        return TriangleSoup{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, "", "", 0, {}, {}};
    }));
    list.push_back(shape("a Moebius strip", "obj", {false, false, {"non_manifold", "open_boundary"}}, moebius_strip));
    list.push_back(shape("a tube that crosses itself", "off", {false, true, {"endpoint_outside"}}, crossing_tube));
    list.push_back({"no bytes", "ply", {false, false, {"file_format"}}, [](const TriangleSoup&, Random&) {
                        return std::string();
                    }});
    list.push_back({"random bytes", "stl", {false, false, kBroken}, [](const TriangleSoup&, Random& random) {
                        std::string bytes(5000, ' ');
                        for (char& c : bytes) c = static_cast<char>(random() % 256);
                        return bytes;
                    }});
    list.push_back(edited(
        "index beyond the vertices", "off", {false, false, {"file_format"}},
        [](TriangleSoup& s, Random& r) { s.triangles[pick(s, r)][1] = static_cast<std::uint32_t>(s.points.size()); }));
}

// A cut or changed file may by chance be a sound one of other triangles: then lines differ, with a warning.
void add_byte_damages(std::vector<Damage>& list) {
    Expected cut{true, true, kBroken};
    cut.failures.merge(std::set<std::string>{"open_boundary", "non_manifold", "no_volume", "endpoints_missing",
                                             "no_outlet", "endpoint_outside", "endpoint_ambiguous", "target_unreached",
                                             "no_line_traced", "not_closed"});
    for (const char* format : {"stl", "ply", "obj", "off", "vtk", "vtp"}) {
        for (const double share : {0.3, 0.99})
            list.push_back({std::string("cut at ") + (share < 0.5 ? "30 %" : "99 %"), format, cut,
                            [format, share](const TriangleSoup& clean, Random&) {
                                const std::string bytes = file_of(clean, format);
                                return bytes.substr(
                                    0, static_cast<std::size_t>(share * static_cast<double>(bytes.size())));
                            }});
        for (const int flips : {1, 20})
            list.push_back({std::to_string(flips) + " bits flipped", format, cut,
                            [format, flips](const TriangleSoup& clean, Random& random) {
                                std::string bytes = file_of(clean, format);
                                for (int i = 0; i < flips; ++i) {
                                    char& c = bytes[random() % bytes.size()];
                                    c = static_cast<char>(c ^ (1 << random() % 8));
                                }
                                return bytes;
                            }});
    }
    for (const char* format : {"stl", "ply", "vtk", "vtp"})
        list.push_back(
            {"byte order swapped", format, {false, false, kBroken}, [format](const TriangleSoup& clean, Random&) {
                 return swapped_file_of(clean, format);
             }});
}

}  // namespace

const std::vector<Damage>& all_damages() {
    static const std::vector<Damage> list = [] {
        std::vector<Damage> damages;
        add_face_damages(damages);
        add_vertex_damages(damages);
        add_whole_shapes(damages);
        add_byte_damages(damages);
        return damages;
    }();
    return list;
}

}  // namespace lumenline::mutation
