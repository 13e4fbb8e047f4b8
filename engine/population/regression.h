#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/population/hypothesis.h"

namespace lumenline {

/// One term of a linear model.
struct RegressionTerm {
    std::string name;
    Interval coefficient;
    double error = 0;  ///< standard error
    TestResult test;   ///< t, against zero
};

/// A linear model fitted by least squares.
struct Regression {
    std::vector<RegressionTerm> terms;  ///< the intercept first
    std::size_t count = 0;              ///< of observations
    double r_squared = 0;
};

/// A predictor: one value per observation.
struct Predictor {
    std::string name;
    std::vector<double> values;
};

/// y = intercept + sum of coefficient x predictor, by ordinary least squares (Householder QR).
/// @returns no terms where observations are too few or predictors depend on each other
Regression fit_linear(std::span<const double> y, std::span<const Predictor> predictors, double confidence);

}  // namespace lumenline
