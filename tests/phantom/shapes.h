#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "engine/phantom/phantom.h"

namespace lumenline {

struct NamedShape {
    std::string name;
    PhantomOptions options;
};

inline PhantomOptions shape_of(PhantomKind kind) {
    PhantomOptions options;
    options.kind = kind;
    return options;
}

/// One of each kind and the awkward ones, in general position and not of unit scale.
inline std::vector<NamedShape> test_shapes() {
    std::vector<NamedShape> shapes;
    const auto add = [&](const std::string& name, PhantomKind kind) -> PhantomOptions& {
        shapes.push_back({name, shape_of(kind)});
        PhantomOptions& o = shapes.back().options;
        o.rotate = true;
        o.rotation_axis = {1, -2, 0.5};
        o.rotation_angle = 0.7;
        o.scale = 0.37;
        o.offset = {3, -20, 11};
        return o;
    };
    add("circle", PhantomKind::kCylinder);
    add("ellipse wide", PhantomKind::kCylinder).b = 2;
    add("ellipse tall", PhantomKind::kCylinder).a = 3;
    add("torus", PhantomKind::kTorus);
    {
        PhantomOptions& o = add("thick torus", PhantomKind::kTorus);
        o.bend_radius = 6;
        o.arc = 2.5;
    }
    add("helix", PhantomKind::kHelix).arc = 5 * std::numbers::pi;
    {
        PhantomOptions& o = add("steep left-handed helix", PhantomKind::kHelix);
        o.bend_radius = 2;
        o.pitch = -60;
        o.arc = 15;
    }
    {
        PhantomOptions& o = add("tight helix", PhantomKind::kHelix);
        o.arc = 14;
        o.pitch = 10.2;
    }
    add("stenosis", PhantomKind::kStenosis);
    {
        PhantomOptions& o = add("sharp stenosis", PhantomKind::kStenosis);
        o.severity = 0.8;
        o.stenosis_width = 1.5;
    }
    add("hairpin", PhantomKind::kHairpin);
    add("hairpin almost touching", PhantomKind::kHairpin).bend_radius = 5.05;
    return shapes;
}

/// Largest distance of a vertex from the origin.
inline double extent_of(const Phantom& p) {
    double extent = 0;
    for (const Vec3& x : p.points) extent = std::max(extent, norm(x));
    return extent;
}

}  // namespace lumenline
