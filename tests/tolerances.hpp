#pragma once

#include <cmath>
#include <limits>

/// The tolerances of all tests, each derived, so that none is tuned until a test passes.
namespace holdfast::tolerances {

constexpr double kEps = std::numeric_limits<double>::epsilon();

/// Closed forms on numbers of about 1: a chain of up to 50 roundings of half an epsilon each, all
/// in one direction, and no cancellation.
constexpr double kRounding = 25 * kEps;

/// log(exp(phi)) where one of the two works next to pi: cos(pi / 2) has an absolute error of one
/// epsilon there, which atan2 hands on once and the factor 2 doubles; the rest is kRounding.
constexpr double kNearPi = 4 * kEps + kRounding;

/// Step of central differences: minimises h^2 / 6 + eps / h, at h = cbrt(3 eps).
inline const double kDifferenceStep = std::cbrt(3 * kEps);

/// Error of a central difference of a function whose third derivative is at most `third` and whose
/// value has a rounding error of at most `rounding` (kRounding for closed forms of size 1).
inline double difference_error(double third = 1.0, double rounding = kRounding) {
  const double h = kDifferenceStep;
  return third * h * h / 6 + rounding / h;
}

/// How far the mean of `n` independent values of standard deviation `sigma` may lie from its
/// expectation: 5 sigma of the mean, which a right generator exceeds once in 1.7 million tests.
inline double mean_error(double sigma, double n) { return 5 * sigma / std::sqrt(n); }

}  // namespace holdfast::tolerances
