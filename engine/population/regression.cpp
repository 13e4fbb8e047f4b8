#include "engine/population/regression.h"

#include <Eigen/Dense>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstddef>

namespace lumenline {

Regression fit_linear(std::span<const double> y, std::span<const Predictor> predictors, double confidence) {
    Regression result;
    result.count = y.size();
    const auto n = static_cast<Eigen::Index>(y.size()), terms = static_cast<Eigen::Index>(predictors.size()) + 1;
    if (n <= terms) return result;
    Eigen::MatrixXd design(n, terms);
    design.col(0).setOnes();
    for (Eigen::Index k = 1; k < terms; ++k)
        design.col(k) = Eigen::Map<const Eigen::VectorXd>(predictors[static_cast<std::size_t>(k - 1)].values.data(), n);
    const Eigen::Map<const Eigen::VectorXd> observed(y.data(), n);
    // Columns are scaled, so that the rank is judged alike whatever the units.
    const Eigen::VectorXd scale = design.colwise().norm();
    if (!(scale.array() > 0).all()) return result;
    const Eigen::MatrixXd scaled = design * scale.cwiseInverse().asDiagonal();
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled);
    if (qr.rank() < terms) return result;
    const Eigen::VectorXd solution = qr.solve(observed);
    const double left = (observed - scaled * solution).squaredNorm();
    const double freedom = static_cast<double>(n - terms), variance = left / freedom;
    const Eigen::MatrixXd inverse = (scaled.transpose() * scaled).inverse();
    const boost::math::students_t distribution(freedom);
    const double reach = boost::math::quantile(distribution, 0.5 + 0.5 * confidence);
    for (Eigen::Index k = 0; k < terms; ++k) {
        RegressionTerm term;
        term.name = k == 0 ? "intercept" : predictors[static_cast<std::size_t>(k - 1)].name;
        const double value = solution[k] / scale[k];
        term.error = std::sqrt(variance * inverse(k, k)) / scale[k];
        term.coefficient = {value, value - reach * term.error, value + reach * term.error};
        if (term.error > 0) {
            const double t = value / term.error;
            term.test = {t, 2 * boost::math::cdf(boost::math::complement(distribution, std::fabs(t)))};
        }
        result.terms.push_back(term);
    }
    const double whole = (observed.array() - observed.mean()).square().sum();
    result.r_squared = whole > 0 ? 1 - left / whole : std::numeric_limits<double>::quiet_NaN();
    return result;
}

}  // namespace lumenline
