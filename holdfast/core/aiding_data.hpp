#pragma once

#include <Eigen/Core>

#include "holdfast/core/se3.hpp"
#include "holdfast/core/time.hpp"

/// Measurements beside LiDAR and IMU that a log may hold. Nothing here estimates with them.
namespace holdfast {

/// What the wheels of a robot tell.
struct WheelSample {
  TimeNs t = 0;                ///< end of the interval over which ticks were counted
  double speed_m_s = 0;        ///< of the body's origin along its x axis
  double yaw_rate_rad_s = 0;   ///< about the body's z axis
  double speed_sigma_m_s = 0;  ///< as the wheels know it: slip is not in it
  double yaw_rate_sigma_rad_s = 0;
  SE3 T_odom_body;  ///< summed up from the above in a plane since the start; drifts
};

/// A position from satellites, WGS 84.
struct GnssSample {
  TimeNs t = 0;
  bool has_fix = false;     ///< without one the position is not a number
  double latitude_deg = 0;  ///< north is positive
  double longitude_deg = 0;
  double altitude_m = 0;  ///< above the ellipsoid
  Eigen::Vector3d sigma_enu_m = Eigen::Vector3d::Zero();
};

}  // namespace holdfast
