#pragma once

#include "holdfast/filter/matching/skew_equations.hpp"

namespace holdfast::filter {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The prior map's own error as a scan feels it: common to many of its points, and so not averaged
/// out by their number. Covariance of an offset of the pose, in the order [position in the map,
/// rotation on the right], and the standard deviation of the position's drift from the first to the
/// last point, which looks like a velocity.
struct MapError {
  Matrix6d pose = 1e-6 * Matrix6d::Identity();
  double velocity_m_s = 0.02;
};

/// Marginalises the map's own error out of the equations, which caps their information: an offset
/// of the map moves a scan as its pose and velocity do.
void marginalise(const MapError& error, ScanEquations& equations);

/// Takes the motion during the scan as known.
void fix_velocity(ScanEquations& equations);

}  // namespace holdfast::filter
