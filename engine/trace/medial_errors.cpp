// Two kinds of error move a line: noise of the sites, and what quadrics cannot follow. Both show in the heights of
// sites above where their neighbours would put them, and which of the two it is shows in their signs: noise of
// neighbouring sites has opposite ones, since each is among the neighbours of the other; what quadrics cannot follow
// has the same. Heights are averaged over a stretch of the line, since the few sites that hold one ball are not a fair
// sample.
//
// Noise. A ball held from all sides is off by about one height. On a sheet, the medial axis of a flat section with
// half axes a > b, the slope of the noise moves the top of the radius along the sheet, against its curvature and the
// tension of the line: by sqrt(R / h) heights and more as the section gets flatter (h: edge). The ball is the smallest
// of many that noise allows: the more sites compete, as there are within its reach, the more its radius falls short.
//
// Form. Heights that vary slowly around a section move its ball by their first harmonic, and change its radius by that
// and by a part of their mean: a stenosis is missed alike on all sides, and its line stays where it is.
//
// The factors were chosen on phantoms of eight seeds, so that estimates cover nine tenths of the points' errors.
#include <Eigen/Core>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "engine/trace/medial.h"

namespace lumenline {

namespace {

constexpr double kStretch = 1.5;      // of the radius: to either side, over which heights are averaged
constexpr double kResolution = 2e-5;  // of the radius: how well nodes are found on a wall without error
constexpr double kForm = 0.1;         // correlation of neighbours' heights: from it on all is form, at zero all noise
constexpr double kPredicted = 1.2;    // heights by noise: neighbours' predictions are noisy themselves
constexpr double kFlattest = 0.05;    // (b / a)^2 of a section
constexpr double kSheet = 1.7;        // of the anisotropy: sections with b < 0.64 a hold their line on a sheet

// In heights:
constexpr double kRoundMove = 1.0, kSheetMove = 0.68, kSheetEdges = 0.72, kSheetNoise = 5.5;
constexpr double kRadius = 0.78, kRoundRadius = 1.2, kCompeting = 0.38, kCrowded = 0.04;
constexpr double kRoundHeights = 3;    // of the radius times the anisotropy: flatter sections are held from two sides
constexpr double kStrongNoise = 0.05;  // of the edge: beyond it places compete more
constexpr double kFormMove = 0.18, kFormRadius = 0.15;
// In amplitudes of the first harmonic, and means, of heights:
constexpr double kHarmonicMove = 0.9, kHarmonicRadius = 0.9, kMeanRadius = 0.25;

}  // namespace

void MedialRefiner::Section::add(const Section& other, double factor) {
    weight += factor * other.weight;
    offset2 += factor * other.offset2;
    product += factor * other.product;
    edge2 += factor * other.edge2;
    mean2 += factor * other.mean2;
    first2 += factor * other.first2;
    anisotropy += factor * other.anisotropy;
}

MedialRefiner::Section MedialRefiner::section(std::size_t i) {
    // The conic x^2 A + xy B + y^2 C + x D + y E = 1 through the places around the node and its neighbours.
    Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
    Eigen::Matrix<double, 5, 1> right = Eigen::Matrix<double, 5, 1>::Zero();
    Section section;
    section.weight = 1;
    const RidgeNode& ridge = problem_.nodes[i];
    double count = 0;
    Eigen::Vector3d harmonics = Eigen::Vector3d::Zero();  // of the heights: mean, cosine, sine
    for (std::size_t j = i > 0 ? i - 1 : 0; j <= std::min(i + 1, nodes_.size() - 1); ++j)
        for (const Contact& c : nodes_[j].around) {
            const Vec3 d = (1 / nodes_[i].radius) * (c.foot.point - problem_.nodes[j].position);
            const double u = dot(d, ridge.axes[0]), v = dot(d, ridge.axes[1]), stretch = norm(d) / std::hypot(u, v);
            const double x = stretch * u, y = stretch * v;
            if (std::isfinite(stretch)) {
                const Eigen::Matrix<double, 5, 1> row{x * x, x * y, y * y, x, y};
                normal += row * row.transpose();
                right += row;
            }
            const auto o = curved_.corner_offsets(c.foot);
            if (const double across = std::hypot(u, v); across > 0)
                harmonics += std::inner_product(o.begin(), o.end(), c.foot.weight.begin(), 0.0) *
                             Eigen::Vector3d(1, 2 * u / across, 2 * v / across);
            const auto& t = curved_.surface().triangles[at(c.foot.triangle)];
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t next = (k + 1) % 3;
                section.offset2 += c.foot.weight[k] * o[k] * o[k];
                section.product += o[k] * o[next] / 3;
                section.edge2 +=
                    squared_norm(curved_.surface().points[at(t[k])] - curved_.surface().points[at(t[next])]) / 3;
            }
            ++count;
        }
    section.offset2 /= count;
    section.product /= count;
    section.edge2 /= count;
    harmonics /= count;
    section.mean2 = harmonics[0] * harmonics[0];
    section.first2 = harmonics.tail<2>().squaredNorm();
    const Eigen::Matrix<double, 5, 1> conic = normal.ldlt().solve(right);
    const double sum = conic[0] + conic[2], difference = std::hypot(conic[0] - conic[2], conic[1]);
    const double ratio2 = (sum - difference) / (sum + difference);
    section.anisotropy = std::isfinite(ratio2) ? 1 - std::clamp(ratio2, kFlattest, 1.0) : 0.0;
    return section;
}

void MedialRefiner::estimate_errors() {
    const std::size_t n = nodes_.size();
    std::vector<Section> sections(n);
    for (std::size_t i = 0; i < n; ++i) sections[i] = section(i);
    std::vector<double> s(n, 0.0);
    for (std::size_t i = 1; i < n; ++i)
        s[i] = s[i - 1] + distance(problem_.nodes[i].position, problem_.nodes[i - 1].position);
    for (std::size_t i = 0; i < n; ++i) {
        if (nodes_[i].frozen) continue;
        const double reach = kStretch * nodes_[i].radius;
        Section mean;
        for (std::size_t j = i; j-- > 0 && s[j] >= s[i] - reach;) mean.add(sections[j], 1);
        for (std::size_t j = i; j < n && s[j] <= s[i] + reach; ++j) mean.add(sections[j], 1);
        Section scaled;
        scaled.add(mean, 1 / mean.weight);
        set_errors(nodes_[i], scaled);
    }
}

void MedialRefiner::set_errors(Node& node, const Section& mean) const {
    const double height2 = mean.offset2, height = std::sqrt(height2), edge = std::sqrt(mean.edge2);
    const double flat = mean.anisotropy, aspect = 1 / std::sqrt(1 - flat);
    const double half = aspect * node.radius / edge;  // a, in edges
    const double noise = height / (kPredicted * edge);
    const double form = height > 0 ? std::clamp(mean.product / height2 / kForm, 0.0, 1.0) : 1.0;

    const double sheet = height * kSheetMove * std::pow(half, kSheetEdges) * aspect *
                         std::sqrt(std::min(kSheet * flat, 1.0)) *
                         (1 + kSheetNoise * aspect * aspect * noise * edge / node.radius);
    const auto harmonic = [&](double first, double constant, double rest) {
        return std::sqrt(first * first * mean.first2 + constant * constant * mean.mean2 + rest * rest * height2);
    };
    const double move = std::lerp(kRoundMove * height, harmonic(kHarmonicMove, 0, kFormMove), form);
    node.position_error = std::hypot(move, sheet, kResolution * node.radius);

    const double competing = noise * half * half * std::min(aspect * std::sqrt(noise / kStrongNoise), 4.0);
    const double two_sided = height > 0 ? flat * node.radius / (kRoundHeights * height) : 0.0;
    const double crowding =
        kRadius + kRoundRadius / (1 + two_sided * two_sided) + kCompeting * competing / (1 + kCrowded * competing);
    const double change = std::lerp(crowding * height, harmonic(kHarmonicRadius, kMeanRadius, kFormRadius), form);
    node.radius_error = std::hypot(change, 0.1 * kResolution * node.radius);
}

double MedialRefiner::noise_level() const {
    std::vector<double> levels;
    for (const Node& node : nodes_)
        if (!node.frozen) levels.push_back(node.uncertainty / node.radius);
    const auto middle = levels.begin() + static_cast<std::ptrdiff_t>(levels.size() / 2);
    std::nth_element(levels.begin(), middle, levels.end());
    return *middle;
}

}  // namespace lumenline
