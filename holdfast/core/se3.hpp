#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "holdfast/core/so3.hpp"
#include "holdfast/core/time.hpp"

namespace holdfast {

/// Rigid transform T_a_b: p_a = T_a_b * p_b = rotation * p_b + translation (metres).
struct SE3 {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  SE3 inverse() const {
    const Eigen::Quaterniond inverse_rotation = rotation.conjugate();
    return {inverse_rotation, -(inverse_rotation * translation)};
  }
  /// T_a_c = T_a_b * T_b_c; the rotation is renormalised.
  SE3 operator*(const SE3& other) const {
    return {(rotation * other.rotation).normalized(), rotation * other.translation + translation};
  }
  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return rotation * p + translation; }
};

/// A body pose with its time.
struct StampedPose {
  TimeNs t = 0;
  SE3 T_map_body;
};

/// Pose at share `u` (0 to 1) of the way from `a` to `b`: straight in translation, constant rate in
/// rotation.
inline SE3 interpolate(const SE3& a, const SE3& b, double u) {
  return {a.rotation.slerp(u, b.rotation), a.translation + u * (b.translation - a.translation)};
}

}  // namespace holdfast
