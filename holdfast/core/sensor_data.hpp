#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/core/se3.hpp"
#include "holdfast/core/time.hpp"

namespace holdfast {

/// One IMU reading in the body frame; the accelerometer reads +g upwards at rest.
struct ImuSample {
  TimeNs t = 0;
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
};

/// One LiDAR return in the lidar frame at its own time of measurement (not deskewed).
struct ScanPoint {
  float x = 0, y = 0, z = 0;        ///< metres; never NaN in a Scan handed to the pipeline
  float intensity = 0;              ///< as the sensor gives it
  std::int32_t time_offset_ns = 0;  ///< from Scan::stamp
  std::uint16_t ring = 0;           ///< laser index from the lowest beam up; 0 without rings
};

/// All returns of one revolution. Points are in the order in which the log holds them.
struct Scan {
  TimeNs stamp = 0;     ///< time of the first point
  TimeNs end_time = 0;  ///< time of the last point (empty scan: stamp + nominal period); pose time
  std::vector<ScanPoint> points;
  bool has_ring = false;
  bool has_point_times = false;      ///< false: offsets are all zero and nothing can be deskewed
  std::uint32_t invalid_points = 0;  ///< NaN or infinite points dropped while reading
};

/// What the wheels of a robot tell. Nothing here estimates with it, nor with satellites.
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

using SensorEvent = std::variant<ImuSample, Scan>;

/// A stream of sensor events in the order of the log: a file, a simulator, a robot.
class SensorSource {
 public:
  virtual ~SensorSource() = default;

  /// The next event; empty at the end of the stream. An Error ends the stream: what cannot be read
  /// at all. What can be survived (a bad message, NaN points) is counted by the source instead.
  virtual Result<std::optional<SensorEvent>> next() = 0;

  /// Share of the stream already read, 0 to 1, for a progress bar.
  virtual double progress() const = 0;
};

}  // namespace holdfast
