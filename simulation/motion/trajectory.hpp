#pragma once

#include <Eigen/Core>
#include <vector>

#include "holdfast/core/se3.hpp"

namespace holdfast::simulation {

/// Where a body is and how it moves.
struct MotionState {
  SE3 T_map_body;
  Eigen::Vector3d v_map = Eigen::Vector3d::Zero();       ///< m/s
  Eigen::Vector3d a_map = Eigen::Vector3d::Zero();       ///< m/s^2, without gravity
  Eigen::Vector3d omega_body = Eigen::Vector3d::Zero();  ///< rad/s
};

/// Position and attitude as numbers: x y z in metres, yaw, pitch, roll in radians, with
/// R_map_body = Rz(yaw) Ry(pitch) Rx(roll). Yaw is continuous, |pitch| < pi/2.
using PoseVector = Eigen::Matrix<double, 6, 1>;

/// R_map_body of a pose vector.
Eigen::Quaterniond rotation_of(const PoseVector& pose);

/// A continuous motion: uniform quintic B-splines of position and attitude angles, four times
/// continuously differentiable, whose velocities, accelerations and angular rates are the exact
/// derivatives.
class Trajectory {
 public:
  /// `control[i]` belongs to the time begin + i * knot; at least 6. The motion stays near the
  /// control poses (it is a smoothed version of them) and is defined from 2 knots after the
  /// first to 2 knots before the last.
  Trajectory(TimeNs begin, TimeNs knot, std::vector<PoseVector> control);

  /// Clamped to the times for which the motion is defined.
  MotionState at(TimeNs t) const;

  /// The pose vector with its first and second derivatives, per s and s^2; clamped likewise.
  struct Values {
    PoseVector pose;
    PoseVector rate;
    PoseVector acceleration;
  };
  Values values_at(TimeNs t) const;

 private:
  TimeNs begin_;
  TimeNs knot_;
  std::vector<PoseVector> control_;
};

}  // namespace holdfast::simulation
