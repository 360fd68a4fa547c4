#pragma once

#include <Eigen/Core>

#include "holdfast/core/se3.hpp"
#include "holdfast/core/time.hpp"

namespace holdfast::estimator {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;
using Matrix18d = Eigen::Matrix<double, 18, 18>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Vector9d = Eigen::Matrix<double, 9, 1>;
using Vector18d = Eigen::Matrix<double, 18, 1>;

/// The unknowns of one node of the graph: the state of article 3.1.1 and, beyond it, gravity in the
/// map frame, since imported maps are not always level. Tangent in the order [position, rotation,
/// velocity, accelerometer bias, gyroscope bias, gravity], the first 15 as in filter::FilterState:
/// all add in their own frames but the rotation, which is perturbed on the right.
struct NodeState {
  enum Offset : int { kP = 0, kR = 3, kV = 6, kBa = 9, kBg = 12, kG = 15, kSize = 18 };

  TimeNs t = 0;
  SE3 T_map_body;
  Eigen::Vector3d v_map = Eigen::Vector3d::Zero();        ///< m/s
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();   ///< m/s^2
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();    ///< rad/s
  Eigen::Vector3d gravity_map = Eigen::Vector3d::Zero();  ///< m/s^2

  /// x [+] d.
  void add(const Vector18d& d) {
    T_map_body.translation += d.segment<3>(kP);
    T_map_body.rotation = (T_map_body.rotation * so3::exp(d.segment<3>(kR))).normalized();
    v_map += d.segment<3>(kV);
    accel_bias += d.segment<3>(kBa);
    gyro_bias += d.segment<3>(kBg);
    gravity_map += d.segment<3>(kG);
  }

  /// d = *this [-] other, with other [+] d = *this.
  Vector18d minus(const NodeState& other) const {
    Vector18d d;
    d.segment<3>(kP) = T_map_body.translation - other.T_map_body.translation;
    d.segment<3>(kR) = so3::log(other.T_map_body.rotation.conjugate() * T_map_body.rotation);
    d.segment<3>(kV) = v_map - other.v_map;
    d.segment<3>(kBa) = accel_bias - other.accel_bias;
    d.segment<3>(kBg) = gyro_bias - other.gyro_bias;
    d.segment<3>(kG) = gravity_map - other.gravity_map;
    return d;
  }
};

/// The block of d((x [+] d) [-] y)/dd at d = 0 that is not the identity: that of the rotation,
/// where `difference` is the rotation part of x [-] y.
inline Eigen::Matrix3d chart_jacobian(const Eigen::Vector3d& difference) {
  return so3::right_jacobian_inverse(difference);
}

}  // namespace holdfast::estimator
