// Thousands of points are one path of round dots, so that they cost a few bytes each; only outliers are elements of
// their own. A point's place across its band is a fraction of the golden ratio's multiples, which spreads neighbours
// and is the same every time.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/export/report_parts.h"

namespace lumenline {

namespace {

constexpr double kWidth = 640, kLeft = 130, kRight = 20, kBand = 34, kTop = 6, kAxis = 30;
constexpr double kGolden = 0.6180339887498949;
constexpr std::size_t kMostLetters = 18;  ///< of a group's name

/// A step of 1, 2 or 5 times a power of ten, so that about five of them cover the range.
double step_of(double range) {
    const double raw = range / 5, power = std::pow(10, std::floor(std::log10(raw)));
    const double share = raw / power;
    return power * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}

struct Scale {
    double low, high;
    [[nodiscard]] double at(double value) const {
        return kLeft + (value - low) / (high - low) * (kWidth - kLeft - kRight);
    }
};

Scale scale_of(const ReportMeasure& measure) {
    bool any = false;
    double low = 0, high = 0;
    for (const ReportGroup& group : measure.groups)
        for (const ReportGroup::Point& point : group.points) {
            low = any ? std::min(low, point.value) : point.value;
            high = any ? std::max(high, point.value) : point.value;
            any = true;
        }
    const double room = high > low ? 0.03 * (high - low) : std::max(std::fabs(high), 1.0) * 0.1;
    return {low - room, high + room};
}

std::string axis_svg(const Scale& scale, double y, const ReportMeasure& measure) {
    std::string svg = fmt::format("<path class=\"axis\" d=\"M{} {:.0f}H{}\"/>", kLeft, y, kWidth - kRight);
    const double step = step_of(scale.high - scale.low);
    for (double tick = std::ceil(scale.low / step) * step; tick <= scale.high; tick += step) {
        if (std::fabs(tick) < step / 1000) tick = 0;
        svg += fmt::format(
            "<path class=\"grid\" d=\"M{:.1f} {}V{:.0f}\"/><text x=\"{:.1f}\" y=\"{:.0f}\" "
            "text-anchor=\"middle\">{:.6g}</text>",
            scale.at(tick), kTop, y, scale.at(tick), y + 14, tick);
    }
    const std::string unit = measure.unit == "1" || measure.unit.empty() ? "" : measure.unit;
    return svg + fmt::format("<text class=\"unit\" x=\"{}\" y=\"{:.0f}\" text-anchor=\"end\">{}</text>",
                             kWidth - kRight, y + 27, html_text(unit));
}

std::string box_svg(const ReportGroup& group, const Scale& scale, double middle) {
    if (group.points.size() < 2) return "";
    const double reach = 1.5 * (group.upper_quartile - group.lower_quartile);
    double low = group.lower_quartile, high = group.upper_quartile;
    for (const ReportGroup::Point& point : group.points) {
        if (point.value >= group.lower_quartile - reach) low = std::min(low, point.value);
        if (point.value <= group.upper_quartile + reach) high = std::max(high, point.value);
    }
    const double left = scale.at(group.lower_quartile), right = scale.at(group.upper_quartile);
    return fmt::format(
        "<path class=\"whisker\" d=\"M{:.1f} {:.1f}H{:.1f}M{:.1f} {:.1f}H{:.1f}\"/>"
        "<rect class=\"box\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>"
        "<path class=\"median\" d=\"M{:.1f} {:.1f}v{:.1f}\"/>",
        scale.at(low), middle, left, right, middle, scale.at(high), left, middle - kBand * 0.3,
        std::max(right - left, 0.5), kBand * 0.6, scale.at(group.median), middle - kBand * 0.3, kBand * 0.6);
}

std::string points_svg(const ReportGroup& group, const Scale& scale, double middle, const Report& report) {
    std::string dots, outliers;
    for (std::size_t k = 0; k < group.points.size(); ++k) {
        const ReportGroup::Point& point = group.points[k];
        const double turn = kGolden * static_cast<double>(k + 1),
                     y = middle + (turn - std::floor(turn) - 0.5) * kBand * 0.5;
        if (!point.is_outlier)
            dots += fmt::format("M{:.1f} {:.1f}h0", scale.at(point.value), y);
        else
            outliers += fmt::format(
                "<a href=\"#{}\"><circle class=\"outlier\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\">"
                "<title>{}: {}</title></circle></a>",
                model_anchor(point.model), scale.at(point.value), y, html_text(report.models[point.model].id),
                html_number(point.value));
    }
    return (dots.empty() ? "" : "<path class=\"dots\" d=\"" + dots + "\"/>") + outliers;
}

}  // namespace

std::string spread_svg(const ReportMeasure& measure, const Report& report) {
    const Scale scale = scale_of(measure);
    const double foot = kTop + kBand * static_cast<double>(measure.groups.size());
    std::string svg = fmt::format("<svg viewBox=\"0 0 {} {:.0f}\" role=\"img\" aria-label=\"{}\">", kWidth,
                                  foot + kAxis, html_text(measure.name));
    svg += axis_svg(scale, foot, measure);
    for (std::size_t g = 0; g < measure.groups.size(); ++g) {
        const ReportGroup& group = measure.groups[g];
        const double middle = kTop + kBand * (static_cast<double>(g) + 0.5);
        const std::string name =
            group.name.size() > kMostLetters ? group.name.substr(0, kMostLetters) + "\xE2\x80\xA6" : group.name;
        svg +=
            fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{} <tspan class=\"count\">{}</tspan></text>",
                        kLeft - 8, middle + 4, html_text(name), group.points.size());
        svg += box_svg(group, scale, middle) + points_svg(group, scale, middle, report);
    }
    return svg + "</svg>";
}

}  // namespace lumenline
