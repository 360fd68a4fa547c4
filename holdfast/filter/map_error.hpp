#pragma once

#include "holdfast/registration/normal_equations.hpp"

namespace holdfast::filter {

/// The prior map's own error as a scan feels it: common to all of its points, and so not averaged
/// out by their number. Covariance of a position offset, standard deviations of a rotation and of
/// the offset's drift from the first to the last point, which looks like a velocity.
struct MapError {
  Eigen::Matrix3d position = 1e-6 * Eigen::Matrix3d::Identity();  ///< covariance, m^2, map frame
  double rotation_rad = 0.0001;
  double velocity_m_s = 0.02;
};

/// Marginalises the map's own error out of the equations, which caps their information.
void marginalise(const MapError& error, registration::NormalEquations& equations);

/// Takes the motion during the scan as known.
void fix_velocity(registration::NormalEquations& equations);

}  // namespace holdfast::filter
