#pragma once

#include <cstddef>

#include "holdfast/core/step_report.hpp"
#include "holdfast/filter/matching/map_error.hpp"
#include "holdfast/registration/normal_equations.hpp"

namespace holdfast::filter {

/// The largest standard deviation, in any direction, of three unknowns with this covariance.
double largest_sigma(const Eigen::Matrix3d& covariance);

/// Likewise of the three from `offset` on.
template <class Covariance>
double largest_sigma(const Covariance& P, int offset) {
  return largest_sigma(Eigen::Matrix3d(P.template block<3, 3>(offset, offset)));
}

/// Writes down what a match of so many selected points came to.
void report_match(const registration::NormalEquations& equations, std::size_t selected,
                  StepReport& report);

/// Writes down how well the pose is known: [position in the map frame, rotation on the right].
void report_covariance(const Matrix6d& P, StepReport& report);

}  // namespace holdfast::filter
