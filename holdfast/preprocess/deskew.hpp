#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "holdfast/core/se3.hpp"
#include "holdfast/core/sensor_data.hpp"
#include "holdfast/preprocess/imu_buffer.hpp"

namespace holdfast::preprocess {

/// What the motion during a scan follows from, at the time of its last point ("end").
struct EndState {
  Eigen::Vector3d v_end = Eigen::Vector3d::Zero();        ///< velocity in the end-body frame, m/s
  Eigen::Vector3d gravity_end = Eigen::Vector3d::Zero();  ///< gravity in the end-body frame, m/s^2
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();
};

/// Motion of the body during one scan, relative to its pose at the last point's time.
///
/// Article 3.1.2 deskews to the first point with the inverse of the motion (its print); ours moves
/// a point by T_end_body(t_i) * T_body_lidar to the *last* point's time, the freshest pose a robot
/// can be given. The IMU is integrated backwards from the end state with the midpoint rule; poses
/// stand at 64 knots and a point is moved from the nearest one to first order (at 3 rad/s and 50 m
/// the remainder is below 0.2 mm).
class ScanMotion {
 public:
  /// `imu` covers [stamp, end]; `T_body_lidar` is the extrinsic calibration.
  void set(const ImuSegment& imu, const EndState& end, const SE3& T_body_lidar, TimeNs stamp,
           TimeNs end_time);

  /// Point `p` of the lidar frame, measured `offset_ns` after the stamp, in the end-body frame.
  Eigen::Vector3f deskew(const ScanPoint& p) const {
    const float x = static_cast<float>(p.time_offset_ns) * knots_per_ns_;
    const int k = std::min(std::max(static_cast<int>(x + 0.5F), 0), kKnots - 1);
    const Knot& knot = knots_[static_cast<std::size_t>(k)];
    const float u = x - static_cast<float>(k);
    const Eigen::Vector3f q(p.x, p.y, p.z);
    return knot.R * q + knot.t + u * (knot.dR * q + knot.dt);
  }

  /// T_end_body at a knot's time, for tests and interpolation.
  const std::vector<SE3>& knot_poses() const { return poses_; }

  static constexpr int kKnots = 64;

 private:
  struct Knot {
    Eigen::Matrix3f R, dR;  ///< of T_end_lidar, and its change over one knot
    Eigen::Vector3f t, dt;
  };

  void set_poses(const ImuSegment& imu, const EndState& end, TimeNs stamp, TimeNs end_time);

  std::array<Knot, kKnots> knots_;
  std::vector<SE3> poses_;
  float knots_per_ns_ = 0;
};

}  // namespace holdfast::preprocess
