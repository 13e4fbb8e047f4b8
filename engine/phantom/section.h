#pragma once

#include <vector>

namespace lumenline {

/// Arc length along the ellipse (a cos t, b sin t), inverted by a table.
class EllipseArc {
public:
    EllipseArc(double a, double b);

    [[nodiscard]] double perimeter() const { return length_.back(); }

    /// Parameter t at the share `u` of the perimeter, counted from t = 0; u may be any number,
    /// each whole turn adds 2 pi. Exact for a circle, else to about 1e-12.
    [[nodiscard]] double parameter(double u) const;

private:
    [[nodiscard]] double arc(double t0, double t1) const;

    double a_, b_;
    std::vector<double> length_;  // from 0 to the i-th of equispaced parameters
};

/// Distance of (x, y) to the ellipse with semi-axes a, b > 0, positive inside. Exact to rounding.
double ellipse_distance(double a, double b, double x, double y);

}  // namespace lumenline
