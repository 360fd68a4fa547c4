#pragma once

#include "holdfast/filter/filter_state.hpp"
#include "holdfast/odometry/bias_jump.hpp"

namespace holdfast::odometry {

/// Gravity in the odometry's frame, estimated beside the state. The local map fixes the rotation to
/// where the frame began, so that an error of the first levelling stays: unlike a bias of the
/// accelerometer it does not turn with the robot, and a filter without it never settles.
///
/// Three further unknowns of the same Kalman filter: since scans do not depend on gravity, their
/// correction follows from that of the state by the covariance of the two.
class GravityEstimate {
 public:
  /// From the mean force (m/s^2, body) over readings in which the robot accelerated by no more than
  /// `acceleration_sigma`, a gravity of size `size` and the uncertainty of the accelerometer's bias
  /// in `state`; corrects bias and covariance of the state by what the readings tell.
  void begin(const Eigen::Vector3d& force, double acceleration_sigma, double size,
             filter::FilterState& state);

  const Eigen::Vector3d& value() const { return gravity_; }
  Eigen::Vector3d sigma() const { return P_.diagonal().cwiseMax(0.0).cwiseSqrt(); }

  /// After a state without covariance was propagated from `before` to `predicted`, so that P is
  /// what noise added: adds what came of the covariance before and of the uncertainty of gravity.
  /// One transition serves all of it, so that the covariance of state and gravity stays one.
  /// Returns the covariance of the errors of `predicted` (rows) and `before`.
  filter::Matrix15d predict(const filter::FilterState& before, filter::FilterState& predicted);
  /// After a scan has corrected `predicted` to `after`: returns by how much of the state's
  /// correction gravity followed.
  Eigen::Matrix<double, 3, 15> correct(const filter::FilterState& predicted,
                                       const filter::FilterState& after);
  /// The errors of the state are now `change` times what they were.
  void change_errors(const filter::Matrix15d& change) { cross_ *= change.transpose(); }
  /// Pose and velocity begin anew; what is known of gravity and biases stays.
  void forget_pose();
  /// The state's biases jumped.
  void allow_for(const BiasJump& jump);
  /// The biases' covariance was replaced.
  void forget_biases();

 private:
  Eigen::Vector3d gravity_ = Eigen::Vector3d(0, 0, -9.81);
  Eigen::Matrix3d P_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 15> cross_ = Eigen::Matrix<double, 3, 15>::Zero();
};

}  // namespace holdfast::odometry
