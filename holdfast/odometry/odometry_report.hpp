#pragma once

#include <optional>

#include "holdfast/core/step_report.hpp"
#include "holdfast/odometry/increment.hpp"

namespace holdfast::odometry {

/// What came of one scan.
struct OdometryReport {
  /// With T_odom_body in place of T_map_body; sigmas are those of the drift since the epoch began.
  StepReport step;
  Eigen::Vector3d v_odom = Eigen::Vector3d::Zero();  ///< m/s, in the odometry's frame
  /// Motion since the scan before; none for the first scan, and where the odometry broke in
  /// between.
  std::optional<Increment> increment;
  bool broke = false;      ///< a new local map begins with this scan; step.odom_epoch has grown
  bool corrected = false;  ///< the scan told the pose, not the IMU alone
};

}  // namespace holdfast::odometry
