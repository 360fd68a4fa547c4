#pragma once

#include "holdfast/filter/filter_state.hpp"
#include "holdfast/registration/correspondences.hpp"

namespace holdfast::filter {

/// Normal equations of a scan, in the order of FilterState.
struct ScanEquations {
  Matrix15d H = Matrix15d::Zero();
  Vector15d g = Vector15d::Zero();
};

/// Normal equations of `pairs` by the pose at the end of the scan, and through the skew by the
/// velocity and both biases. A point that was measured a time a before the end stands in the body
/// frame of the end at
///   q - a v + a^2/2 (accel - b_a) + a (gyro - b_g) x q,   to first order in what is uncertain.
/// Robust weights as in registration::linearise.
ScanEquations linearise_with_skew(const registration::Correspondences& pairs,
                                  const SE3& T_anchor_body, double robust_scale);

}  // namespace holdfast::filter
