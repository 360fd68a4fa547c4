#include "holdfast/odometry/increment.hpp"

namespace holdfast::odometry {
namespace {

using filter::FilterState;
using filter::Matrix15d;

}  // namespace

Matrix15d error_transition(const FilterState& a, const FilterState& b,
                           const Eigen::Vector3d& gravity) {
  const double dt = to_seconds(b.t - a.t);
  const Eigen::Matrix3d R = a.T_map_body.rotation.toRotationMatrix();
  const Eigen::Matrix3d turn =
      (b.T_map_body.rotation.conjugate() * a.T_map_body.rotation).toRotationMatrix();
  const Eigen::Matrix3d R_middle =
      a.T_map_body.rotation.slerp(0.5, b.T_map_body.rotation).toRotationMatrix();
  const Eigen::Vector3d dv = b.v_map - a.v_map - dt * gravity;
  const Eigen::Vector3d dp =
      b.T_map_body.translation - a.T_map_body.translation - dt * a.v_map - 0.5 * dt * dt * gravity;
  Matrix15d F = Matrix15d::Identity();
  F.block<3, 3>(FilterState::kP, FilterState::kR) = -so3::hat(dp) * R;
  F.block<3, 3>(FilterState::kP, FilterState::kV) = dt * Eigen::Matrix3d::Identity();
  F.block<3, 3>(FilterState::kP, FilterState::kBa) = -0.5 * dt * dt * R_middle;
  F.block<3, 3>(FilterState::kR, FilterState::kR) = turn;
  F.block<3, 3>(FilterState::kR, FilterState::kBg) = -dt * Eigen::Matrix3d::Identity();
  F.block<3, 3>(FilterState::kV, FilterState::kR) = -so3::hat(dv) * R;
  F.block<3, 3>(FilterState::kV, FilterState::kBa) = -dt * R_middle;
  // The rotation's error grows while the force acts.
  F.block<3, 3>(FilterState::kV, FilterState::kBg) = 0.5 * dt * so3::hat(dv) * R_middle;
  F.block<3, 3>(FilterState::kP, FilterState::kBg) = dt / 3.0 * so3::hat(dp) * R_middle;
  return F;
}

Increment increment_between(const FilterState& before, const FilterState& after,
                            const Matrix15d& after_before) {
  Increment increment;
  increment.T_prev_cur = before.T_map_body.inverse() * after.T_map_body;
  const Eigen::Matrix3d R = before.T_map_body.rotation.toRotationMatrix();
  Matrix6d J_before = Matrix6d::Zero();
  J_before.topLeftCorner<3, 3>() = -R.transpose();
  J_before.topRightCorner<3, 3>() = so3::hat(increment.T_prev_cur.translation);
  J_before.bottomRightCorner<3, 3>() =
      -increment.T_prev_cur.rotation.toRotationMatrix().transpose();
  Matrix6d J_after = Matrix6d::Identity();
  J_after.topLeftCorner<3, 3>() = R.transpose();
  const Matrix6d mixed = J_after * after_before.topLeftCorner<6, 6>() * J_before.transpose();
  const Matrix6d sum = J_before * before.P.topLeftCorner<6, 6>() * J_before.transpose() +
                       J_after * after.P.topLeftCorner<6, 6>() * J_after.transpose() + mixed +
                       mixed.transpose();
  increment.covariance = 0.5 * (sum + sum.transpose());
  return increment;
}

Matrix6d compose_covariance(const SE3& T_a_b, const Matrix6d& P_a_b, const Increment& b_c) {
  const Eigen::Matrix3d R = T_a_b.rotation.toRotationMatrix();
  Matrix6d J_left = Matrix6d::Identity();
  J_left.topRightCorner<3, 3>() = -R * so3::hat(b_c.T_prev_cur.translation);
  J_left.bottomRightCorner<3, 3>() = b_c.T_prev_cur.rotation.toRotationMatrix().transpose();
  Matrix6d J_right = Matrix6d::Identity();
  J_right.topLeftCorner<3, 3>() = R;
  const Matrix6d P =
      J_left * P_a_b * J_left.transpose() + J_right * b_c.covariance * J_right.transpose();
  return 0.5 * (P + P.transpose());
}

}  // namespace holdfast::odometry
