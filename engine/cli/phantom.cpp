// The verb `phantom`. Which option belongs to which kinds stands in one table, from which the help
// texts and the refusals are made; everything else is checked by make_phantom.
#include "engine/cli/phantom.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/cli/phantom_table.h"
#include "engine/cli/run.h"
#include "engine/core/text.h"
#include "engine/phantom/phantom.h"
#include "engine/phantom/tree.h"
#include "engine/phantom/voxels.h"
#include "io/archive/commit.h"
#include "io/mesh/mesh_io.h"

namespace lumenline {
namespace {

using enum PhantomKind;

struct PhantomArguments {
    PhantomOptions options;
    VoxelOptions voxels{0, 0};
    std::string kind, output, truth, offset;
    double turns = 0.75;
    double length = 50;
};

struct TreeArguments {
    TreeOptions options;
    std::string output, truth, offset;
};

// An option that only some kinds have.
struct KindOption {
    CLI::Option* option;
    std::vector<PhantomKind> kinds;
};

constexpr std::array kKinds{kCylinder, kTorus, kHelix, kStenosis, kHairpin};

PhantomKind parse_kind(const std::string& name) {
    std::string known;
    for (const PhantomKind kind : kKinds) {
        if (name == phantom_name(kind)) return kind;
        known += (known.empty() ? "" : ", ") + std::string(phantom_name(kind));
    }
    throw std::invalid_argument("KIND is '" + name + "', must be one of: " + known);
}

Vec3 parse_offset(const std::string& text) {
    Vec3 p;
    char after = 0;
    // The trailing %c catches anything behind the third number.
    if (std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &p.x, &p.y, &p.z, &after) != 3 || !std::isfinite(p.x + p.y + p.z)) {
        throw std::invalid_argument("--offset: expected three numbers as X,Y,Z, got '" + text + "'");
    }
    return p;
}

void refuse_foreign_options(PhantomKind kind, const std::vector<KindOption>& table) {
    for (const auto& [option, kinds] : table) {
        if (option->count() == 0 || std::find(kinds.begin(), kinds.end(), kind) != kinds.end()) continue;
        std::string owners;
        for (const PhantomKind owner : kinds) owners += (owners.empty() ? "" : ", ") + std::string(phantom_name(owner));
        throw std::invalid_argument(
            fmt::format("{} has no meaning for a {}, only for: {}", option->get_name(), phantom_name(kind), owners));
    }
}

// The options as the library wants them: circular sections have b = a, a hairpin's length is its legs'.
PhantomOptions resolved(const PhantomArguments& arguments) {
    PhantomOptions o = arguments.options;
    o.kind = parse_kind(arguments.kind);
    if (o.kind != kCylinder) o.b = o.a;
    (o.kind == kHairpin ? o.leg_length : o.length) = arguments.length;
    o.arc = 2 * std::numbers::pi * arguments.turns;
    if (!arguments.offset.empty()) o.offset = parse_offset(arguments.offset);
    return o;
}

// Rows of abscissa, axis point and inscribed radius, a quarter of an edge apart or a little less, from `inset` after
// the start to `inset` before the end.
void write_truth(const std::string& path, const Phantom& phantom, double inset) {
    const double length = phantom.truth.total_length();
    inset = std::min(inset, 0.25 * length);
    const auto steps = static_cast<std::size_t>(std::ceil(4 * (length - 2 * inset) / phantom.edge_length));
    write_file(path, [&](std::ostream& file) {
        file << "abscissa\tx\ty\tz\tradius\n";
        for (std::size_t i = 0; i <= steps; ++i) {
            const double s = inset + (length - 2 * inset) * (static_cast<double>(i) / static_cast<double>(steps));
            const Vec3 p = phantom.truth.position(s);
            file << exact_text(s) << '\t' << exact_text(p.x) << '\t' << exact_text(p.y) << '\t' << exact_text(p.z)
                 << '\t' << exact_text(phantom.truth.inscribed_radius(s)) << '\n';
        }
    });
}

int run(const PhantomArguments& arguments, const std::vector<KindOption>& table) {
    Phantom phantom;
    try {
        refuse_foreign_options(parse_kind(arguments.kind), table);
        phantom = arguments.voxels.size > 0 ? make_voxel_phantom(resolved(arguments), arguments.voxels)
                                            : make_phantom(resolved(arguments));
    } catch (const std::invalid_argument& error) {
        fmt::print(stderr, "lumenline phantom: {}\n", error.what());
        return kUsage;
    }
    refuse_overwriting(arguments.truth, arguments.output);
    write_surface(output_file(arguments.output).string(), phantom.points, phantom.triangles);
    // The ends of a sampled shape are staircases themselves: two voxels before them the axis is inside.
    const double inset = arguments.voxels.size > 0 ? 2 * phantom.edge_length : 0;
    if (!arguments.truth.empty()) write_truth(arguments.truth, phantom, inset);
    return kDone;
}

// Rows of the axis of every branch, a quarter of an edge apart or a little less. Abscissas count from the root.
void write_truth(const std::string& path, const TreePhantom& tree, int points_around) {
    write_file(path, [&](std::ostream& file) {
        file << "branch\tparent\tabscissa\tx\ty\tz\tradius\tnear_junction\n";
        const auto& branches = tree.truth.branches();
        for (std::size_t i = 0; i < branches.size(); ++i) {
            const TreeBranch& b = branches[i];
            const double edge = 2 * std::numbers::pi * b.end_radius / points_around;
            const auto steps = static_cast<std::size_t>(std::ceil(4 * b.length() / edge));
            const std::string parent = b.parent == TreeBranch::kNoParent ? "-1" : std::to_string(b.parent);
            for (std::size_t k = 0; k <= steps; ++k) {
                const TreeAbscissa at{i, b.length() * (static_cast<double>(k) / static_cast<double>(steps))};
                const Vec3 p = tree.truth.position(at);
                file << i << '\t' << parent << '\t' << exact_text(b.abscissa + at.s) << '\t' << exact_text(p.x) << '\t'
                     << exact_text(p.y) << '\t' << exact_text(p.z) << '\t'
                     << exact_text(tree.truth.inscribed_radius(at)) << '\t' << (tree.truth.near_junction(at) ? 1 : 0)
                     << '\n';
            }
        }
    });
}

int run(const TreeArguments& arguments) {
    TreePhantom tree;
    TreeOptions options = arguments.options;
    try {
        if (!arguments.offset.empty()) options.offset = parse_offset(arguments.offset);
        tree = make_tree(options);
    } catch (const std::invalid_argument& error) {
        fmt::print(stderr, "lumenline phantom: {}\n", error.what());
        return kUsage;
    }
    refuse_overwriting(arguments.truth, arguments.output);
    write_surface(output_file(arguments.output).string(), tree.points, tree.triangles);
    if (!arguments.truth.empty()) write_truth(arguments.truth, tree, options.points_around);
    return kDone;
}

void add_tree(CLI::App& phantom, std::function<int()>& action) {
    auto arguments = std::make_shared<TreeArguments>();
    TreeOptions& o = arguments->options;
    CLI::App* verb = phantom.add_subcommand("tree", "Write a branching lumen of blended, tapered tubes and its truth");
    verb->add_option("-o,--output", arguments->output, "Surface file to write: .stl, .ply, .obj, .off or .vtk")
        ->required();
    verb->add_option("--leaves", o.leaves, "Outlets: a power of two")->capture_default_str();
    verb->add_option("--a", o.a, "Radius at the root")->capture_default_str();
    verb->add_option("--length", o.length, "Of a branch, in its own radii")->capture_default_str();
    verb->add_option("--points-around", o.points_around, "Edges around a tube, on the leaves as on the root")
        ->capture_default_str();
    verb->add_option("--seed", o.seed, "Of directions and lengths")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    verb->add_flag("--capped", o.caps, "Close root and leaves with flat caps");
    verb->add_option("--scale", o.scale, "Factor for all lengths")->capture_default_str();
    verb->add_option("--offset", arguments->offset, "Shift X,Y,Z after scaling");
    verb->add_option(
        "--truth", arguments->truth,
        "Write the axes of all branches to this TSV file: inscribed radius, and whether a junction is near");
    verb->footer(
        "Example: lumenline phantom tree -o tree.ply --leaves 8 --truth tree.tsv\n"
        "Exit status: 0 written, 1 a file could not be written, 2 usage error or impossible geometry.");
    verb->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

std::vector<KindOption> add_shape_options(CLI::App& verb, PhantomArguments& arguments) {
    PhantomOptions& o = arguments.options;
    std::vector<KindOption> table;
    const auto add = [&](const std::string& name, double& value, const std::string& help,
                         const std::vector<PhantomKind>& kinds) {
        table.push_back({verb.add_option(name, value, help)->capture_default_str(), kinds});
    };
    verb.add_option("--a", o.a, "Radius of the tube; cylinder: first semi-axis; stenosis: healthy radius")
        ->capture_default_str();
    add("--b", o.b, "Cylinder: second semi-axis", {kCylinder});
    add("--length", arguments.length, "Cylinder, stenosis: length of the axis; hairpin: of each leg",
        {kCylinder, kStenosis, kHairpin});
    add("--bend-radius", o.bend_radius, "Torus, helix: radius of the axis; hairpin: half the distance of its legs",
        {kTorus, kHelix, kHairpin});
    add("--turns", arguments.turns, "Torus (less than 1), helix: turns of the axis", {kTorus, kHelix});
    add("--pitch", o.pitch, "Helix: rise per turn; negative = left-handed", {kHelix});
    add("--severity", o.severity, "Stenosis: reduction of the diameter at the throat, as a share", {kStenosis});
    add("--width", o.stenosis_width, "Stenosis: w of the profile exp(-(z/w)^2)", {kStenosis});
    return table;
}

void add_mesh_options(CLI::App& verb, PhantomArguments& arguments) {
    PhantomOptions& o = arguments.options;
    verb.add_option("--points-around", o.points_around, "Vertices per ring")->capture_default_str();
    verb.add_option("--jitter", o.jitter, "Largest shift of vertices within the wall, in edges")->capture_default_str();
    verb.add_option("--noise", o.noise, "Standard deviation of vertices along the normal, in edges")
        ->capture_default_str();
    verb.add_option("--seed", o.seed, "Of jitter and noise")->check(CLI::NonNegativeNumber)->capture_default_str();
    verb.add_flag("--capped", o.caps, "Close the ends with flat caps");
    verb.add_flag("--rotate", o.rotate, "Turn into general position by a fixed rotation");
    verb.add_option("--scale", o.scale, "Factor for all lengths")->capture_default_str();
    verb.add_option("--offset", arguments.offset, "Shift X,Y,Z after scaling");
    verb.add_flag("--float32", o.float32, "Round coordinates to float32");
    CLI::Option* voxel = verb.add_option("--voxel", arguments.voxels.size,
                                         "Sample the shape in voxels of this share of its least radius: a staircase "
                                         "with closed ends")
                             ->check(CLI::PositiveNumber);
    for (const char* name : {"--points-around", "--jitter", "--noise", "--capped"})
        voxel->excludes(verb.get_option(name));
    verb.add_option("--smoothing", arguments.voxels.smoothing, "Passes of Taubin's smoothing over the staircase")
        ->needs(voxel);
    verb.add_option("--truth", arguments.truth, "Write abscissa, axis point and inscribed radius to this TSV file");
}

}  // namespace

void add_phantom(CLI::App& app, std::function<int()>& action) {
    auto arguments = std::make_shared<PhantomArguments>();
    CLI::App* verb = app.add_subcommand("phantom", "Write an analytic test shape and its truth");
    verb->require_subcommand(0, 1);
    add_tree(*verb, action);
    add_phantom_table(*verb, action);
    // Required, but not beside a subcommand, which CLI11 cannot express.
    verb->add_option("KIND", arguments->kind, "cylinder, torus, helix, stenosis or hairpin; or a subcommand");
    verb->add_option("-o,--output", arguments->output,
                     "Surface file to write (required): .stl, .ply, .obj, .off or .vtk");
    const std::vector<KindOption> table = add_shape_options(*verb, *arguments);
    add_mesh_options(*verb, *arguments);
    verb->footer(
        "Examples:\n"
        "  lumenline phantom cylinder -o tube.ply --b 3 --jitter 0.2 --truth tube.tsv\n"
        "  lumenline phantom helix -o coil.stl --turns 3 --pitch 15 --capped\n"
        "  lumenline phantom stenosis -o narrow.ply --severity 0.7 --width 4 --noise 0.05 --seed 7\n"
        "  lumenline phantom hairpin -o loop.obj --a 5 --bend-radius 5.2\n"
        "  lumenline phantom torus -o stairs.ply --rotate --voxel 0.2 --smoothing 20 --truth stairs.tsv\n"
        "  lumenline phantom tree -o tree.ply --leaves 8 --truth tree_axes.tsv\n"
        "  lumenline phantom table --seeds 1 --rows 3/5-10\n"
        "Of a sampled shape the first and the last row of the truth serve as inlet and outlet.\n"
        "Write a negative shift as --offset=-1,2,3. Options that a KIND does not use are refused.\n"
        "Exit status: 0 written, 1 a file could not be written, 2 usage error or impossible geometry.");
    verb->callback([arguments, table, verb, &action] {
        if (!verb->get_subcommands().empty()) return;
        if (arguments->kind.empty()) throw CLI::RequiredError("KIND");
        if (arguments->output.empty()) throw CLI::RequiredError("--output");
        action = [arguments, table] { return run(*arguments, table); };
    });
}

}  // namespace lumenline
