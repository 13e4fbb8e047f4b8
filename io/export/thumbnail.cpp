// Drawn at three times the size. A pixel takes the mean of its nine cells, as a place in a palette of hues by lights;
// at the outline the palette has the same hues with less opacity, so that the picture stands on light and dark grounds.

#include "io/export/thumbnail.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "io/archive/line_names.h"
#include "io/archive/names.h"
#include "io/export/raster.h"

namespace lumenline {

namespace {

using Numbers = std::vector<double>;

constexpr std::size_t kHues = 25, kLights = 8;  ///< the last hue is grey: no value
constexpr std::size_t kCells = 3;               ///< per pixel, in each direction
constexpr std::size_t kAll = kCells * kCells;
constexpr std::size_t kOutline = 3;  ///< steps of opacity of an outline's pixel, below full
constexpr double kShare = 0.98;      ///< of the values that the colours tell apart
constexpr double kMargin = 6;        ///< in cells
constexpr double kLine = 1.6;        ///< radius of a line, in cells
constexpr std::array<std::array<double, 3>, 10> kViridis{{{68, 1, 84},
                                                          {72, 40, 120},
                                                          {62, 74, 137},
                                                          {49, 104, 142},
                                                          {38, 130, 142},
                                                          {31, 158, 137},
                                                          {53, 183, 121},
                                                          {109, 205, 89},
                                                          {180, 222, 44},
                                                          {253, 231, 37}}};
constexpr std::array<double, 3> kGrey{150, 150, 150};

/// What a picture needs of a model.
struct Wall {
    Numbers points, normals, hue;      ///< hue per site, 0 to 1; NaN = none
    std::vector<std::size_t> corners;  ///< of the wall's triangles
    Numbers line_points;
    std::vector<std::size_t> line_starts;  ///< one more than there are lines
};

[[noreturn]] void contradict(const ArchiveFile& file, const names::Field& field) {
    throw ArchiveError("cannot use '" + file.file().string() + "': " + field.path + " contradicts the points");
}

Numbers rows(const ArchiveFile& file, const names::Field& field, std::size_t count) {
    Numbers values = file.numbers(field.path);
    if (values.size() != count) contradict(file, field);
    return values;
}

std::vector<std::size_t> indices(const ArchiveFile& file, const names::Field& field, const Numbers& values,
                                 std::size_t limit) {
    std::vector<std::size_t> result;
    result.reserve(values.size());
    for (const double value : values) {
        if (!(value >= 0 && value < static_cast<double>(limit))) contradict(file, field);
        result.push_back(static_cast<std::size_t>(value));
    }
    return result;
}

Wall read_wall(const ArchiveFile& file) {
    Wall wall;
    wall.points = file.numbers(names::kSurfacePoints.path);
    const std::size_t sites = wall.points.size() / 3;
    if (wall.points.size() != 3 * sites) contradict(file, names::kSurfacePoints);
    wall.normals = rows(file, names::kNormals, 3 * sites);
    const Numbers triangles = file.numbers(names::kTriangles.path);
    if (triangles.size() % 3 != 0) contradict(file, names::kTriangles);
    const Numbers cap = rows(file, names::kCap, triangles.size() / 3);
    const std::vector<std::size_t> corners = indices(file, names::kTriangles, triangles, sites);
    for (std::size_t k = 0; k < corners.size(); ++k)
        if (cap[k / 3] == -1) wall.corners.push_back(corners[k]);
    if (!file.has(names::kLinePoints.path)) return wall;
    wall.line_points = file.numbers(names::kLinePoints.path);
    const Numbers offsets = file.numbers(names::kLineOffsets.path);
    wall.line_starts = indices(file, names::kLineOffsets, offsets, wall.line_points.size() / 3 + 1);
    if (!std::is_sorted(wall.line_starts.begin(), wall.line_starts.end())) contradict(file, names::kLineOffsets);
    return wall;
}

/// Hues by D_g. @returns the value of the last colour
double colour(const ArchiveFile& file, Wall& wall) {
    const std::size_t sites = wall.points.size() / 3;
    wall.hue.assign(sites, std::numeric_limits<double>::quiet_NaN());
    if (!file.has(names::kGeodesic.path)) return 0;
    const Numbers distance = rows(file, names::kGeodesic, sites);
    Numbers known;
    for (const std::size_t s : wall.corners)
        if (std::isfinite(distance[s])) known.push_back(distance[s]);
    if (known.empty()) return 0;
    const auto place = known.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(known.size() - 1));
    std::nth_element(known.begin(), place, known.end());
    const double largest = *place;
    if (!(largest > 0)) return 0;
    for (std::size_t s = 0; s < sites; ++s) wall.hue[s] = std::clamp(distance[s] / largest, 0.0, 1.0);
    return largest;
}

/// From the model to the canvas.
class View {
public:
    View(const Wall& wall, std::size_t size) {
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        std::size_t count = 0;
        const auto each = [&](auto use) {
            for (const std::size_t s : wall.corners)
                if (const Eigen::Vector3d p(&wall.points[3 * s]); p.allFinite()) use(p);
        };
        each([&](const Eigen::Vector3d& p) { mean += p, ++count; });
        if (count == 0) return;
        mean /= static_cast<double>(count);
        Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
        each([&](const Eigen::Vector3d& p) { spread += (p - mean) * (p - mean).transpose(); });
        if (!spread.allFinite() || !(spread.trace() > 0)) return;
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread / spread.trace());
        across_ = upright(axes.eigenvectors().col(2));
        up_ = upright(axes.eigenvectors().col(1));
        towards_ = across_.cross(up_);
        Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::max()), high = -low;
        each([&](const Eigen::Vector3d& p) {
            const Eigen::Vector3d seen = turned(p);
            low = low.cwiseMin(seen);
            high = high.cwiseMax(seen);
        });
        const double extent = std::max(high.x() - low.x(), high.y() - low.y());
        if (!std::isfinite(extent) || !(extent > 0)) return;
        centre_ = (low + high) / 2;
        scale_ = (static_cast<double>(size) - 2 * kMargin) / extent;
        half_ = static_cast<double>(size) / 2;
    }

    [[nodiscard]] bool is_seen() const { return scale_ > 0; }
    [[nodiscard]] Vec3 place(const double* xyz) const {
        const Eigen::Vector3d p = scale_ * (turned(Eigen::Vector3d(xyz)) - centre_);
        return {half_ + p.x(), half_ - p.y(), p.z()};
    }
    /// Light from above on the left, on either side of the wall.
    [[nodiscard]] double light(const double* normal) const {
        const Eigen::Vector3d n = turned(Eigen::Vector3d(normal));
        const double along = std::fabs(n.dot(Eigen::Vector3d(-0.35, 0.45, 0.82)));
        return std::isfinite(along) ? std::clamp(along, 0.0, 1.0) : 0;
    }

private:
    [[nodiscard]] Eigen::Vector3d turned(const Eigen::Vector3d& p) const {
        return {across_.dot(p), up_.dot(p), towards_.dot(p)};
    }
    /// Of the two directions of an axis the one whose largest coordinate is positive.
    static Eigen::Vector3d upright(const Eigen::Vector3d& axis) {
        Eigen::Index largest = 0;
        axis.cwiseAbs().maxCoeff(&largest);
        return axis[largest] < 0 ? Eigen::Vector3d(-axis) : axis;
    }

    Eigen::Vector3d across_ = Eigen::Vector3d::UnitX(), up_ = Eigen::Vector3d::UnitY(),
                    towards_ = Eigen::Vector3d::UnitZ(), centre_ = Eigen::Vector3d::Zero();
    double scale_ = 0, half_ = 0;
};

void draw(const Wall& wall, const View& view, Canvas& canvas) {
    for (std::size_t k = 0; k + 2 < wall.corners.size(); k += 3) {
        std::array<Corner, 3> triangle;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t s = wall.corners[k + c];
            triangle[c] = {view.place(&wall.points[3 * s]), wall.hue[s], view.light(&wall.normals[3 * s])};
        }
        canvas.draw(triangle);
    }
    for (std::size_t line = 0; line + 1 < wall.line_starts.size(); ++line)
        for (std::size_t k = wall.line_starts[line]; k + 1 < wall.line_starts[line + 1]; ++k) {
            canvas.stroke(view.place(&wall.line_points[3 * k]), view.place(&wall.line_points[3 * k + 3]), kLine);
        }
}

std::array<std::uint8_t, 4> shaded(std::size_t hue, double light, double opacity) {
    std::array<double, 3> colour = kGrey;
    if (hue + 1 < kHues) {
        const double place = static_cast<double>(hue) / (kHues - 2) * (kViridis.size() - 1);
        const std::size_t low = std::min(static_cast<std::size_t>(place), kViridis.size() - 2);
        for (std::size_t c = 0; c < 3; ++c)
            colour[c] =
                kViridis[low][c] + (place - static_cast<double>(low)) * (kViridis[low + 1][c] - kViridis[low][c]);
    }
    const double bright = 0.45 + 0.65 * light;
    std::array<std::uint8_t, 4> result{};
    for (std::size_t c = 0; c < 3; ++c) result[c] = static_cast<std::uint8_t>(std::min(255.0, bright * colour[c]));
    result[3] = static_cast<std::uint8_t>(255 * opacity);
    return result;
}

/// Ground, line, hues by lights, then outlines: eight hues by covered cells.
struct Palette {
    static constexpr std::size_t kLine = 1, kFull = 2, kEdge = kFull + kHues * kLights, kEdgeHues = 8;

    static std::vector<std::array<std::uint8_t, 4>> colours() {
        std::vector<std::array<std::uint8_t, 4>> all{{0, 0, 0, 0}, {233, 30, 99, 255}};
        for (std::size_t hue = 0; hue < kHues; ++hue)
            for (std::size_t light = 0; light < kLights; ++light)
                all.push_back(shaded(hue, static_cast<double>(light) / (kLights - 1), 1));
        for (std::size_t hue = 0; hue < kEdgeHues; ++hue)
            for (std::size_t covered = 1; covered <= kOutline; ++covered)
                all.push_back(
                    shaded(hue * (kHues - 1) / (kEdgeHues - 1), 0.3, static_cast<double>(covered) / (kOutline + 1)));
        return all;
    }
};

std::uint8_t pixel_of(const Canvas& canvas, std::size_t x, std::size_t y) {
    std::size_t covered = 0, line = 0, hues = 0;
    double hue = 0, light = 0;
    for (std::size_t j = 0; j < kCells; ++j)
        for (std::size_t i = 0; i < kCells; ++i) {
            const Canvas::Cell& cell = canvas.at(kCells * x + i, kCells * y + j);
            line += cell.line ? 1 : 0;
            if (!cell.covered) continue;
            ++covered;
            light += cell.light;
            if (std::isnan(cell.hue)) continue;
            hue += cell.hue;
            ++hues;
        }
    if (2 * line >= kAll) return Palette::kLine;
    const std::size_t opacity = (covered * (kOutline + 1) + kAll / 2) / kAll;
    if (opacity == 0) return 0;
    const std::size_t h =
        hues == 0 ? kHues - 1 : static_cast<std::size_t>(hue / static_cast<double>(hues) * (kHues - 2) + 0.5);
    if (opacity <= kOutline)
        return static_cast<std::uint8_t>(Palette::kEdge + h * (Palette::kEdgeHues - 1) / (kHues - 1) * kOutline +
                                         opacity - 1);
    const auto l = static_cast<std::size_t>(light / static_cast<double>(covered) * (kLights - 1) + 0.5);
    return static_cast<std::uint8_t>(Palette::kFull + h * kLights + std::min(l, kLights - 1));
}

}  // namespace

Thumbnail draw_model(const ArchiveFile& model, std::size_t size) {
    Thumbnail result;
    if (!model.has(names::kSurfacePoints.path)) return result;
    Wall wall = read_wall(model);
    result.largest = colour(model, wall);
    if (result.largest > 0) result.quantity = "D_g";
    Canvas canvas(kCells * size);
    const View view(wall, canvas.size());
    if (!view.is_seen()) return result;
    draw(wall, view, canvas);
    result.picture = {size, size, {}, Palette::colours()};
    for (std::size_t y = 0; y < size; ++y)
        for (std::size_t x = 0; x < size; ++x) result.picture.pixels.push_back(pixel_of(canvas, x, y));
    return result;
}

}  // namespace lumenline
