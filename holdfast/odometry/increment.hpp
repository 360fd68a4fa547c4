#pragma once

#include "holdfast/filter/filter_state.hpp"

namespace holdfast::odometry {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Motion since the scan before, in the body frame of that scan: T_prev_cur = T_odom_prev^-1 *
/// T_odom_cur. Errors in the order [position in prev, rotation perturbed on the right].
struct Increment {
  SE3 T_prev_cur;
  Matrix6d covariance = Matrix6d::Identity();
};

/// Transition of the state's errors over one scan, from `from` to `to` (propagated), to first order
/// in its length.
filter::Matrix15d error_transition(const filter::FilterState& from, const filter::FilterState& to,
                                   const Eigen::Vector3d& gravity);

/// The increment from `before` to `after`. Errors of both ends are correlated: what the scan did
/// not correct, the IMU carried over from before. `after_before` is the covariance of the errors of
/// `after` (rows) and `before`.
Increment increment_between(const filter::FilterState& before, const filter::FilterState& after,
                            const filter::Matrix15d& after_before);

/// Covariance of T_a_c = T_a_b * T_b_c from that of T_a_b and that of an independent increment
/// T_b_c, both [position in the frame on the left, rotation on the right].
Matrix6d compose_covariance(const SE3& T_a_b, const Matrix6d& P_a_b, const Increment& b_c);

}  // namespace holdfast::odometry
