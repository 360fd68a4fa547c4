#pragma once

#include <Eigen/Core>
#include <vector>

#include "holdfast/core/parallel.hpp"
#include "holdfast/core/se3.hpp"
#include "holdfast/registration/correspondences.hpp"

namespace holdfast::registration {

/// Order of the unknowns: position (added in the map frame), rotation (R * exp(phi)), and the
/// velocity at the end of the scan in the map frame, on which the deskewed points depend.
enum Block : int { kPosition = 0, kRotation = 3, kVelocity = 6, kUnknowns = 9 };

using Matrix9d = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Vector9d = Eigen::Matrix<double, kUnknowns, 1>;

/// A linearised scan: cost(x + d) ~ cost + 2 g.d + d.H d, with robust weights.
struct NormalEquations {
  Matrix9d H = Matrix9d::Zero();
  Vector9d g = Vector9d::Zero();
  double cost = 0;          ///< sum of squared whitened residuals, bounded by the robust loss
  double weight = 0;        ///< sum of robust weights: how many pairs are believed
  double abs_residual = 0;  ///< sum of weight * |distance|, m
  double pairs = 0;         ///< pairs within the gate
  /// Information about the position that is only seeming (degeneracy.hpp); zero from `linearise`.
  Eigen::Matrix3d feigned = Eigen::Matrix3d::Zero();

  NormalEquations& operator+=(const NormalEquations& other);
};

/// Point-to-plane residuals r = n . (R q + p) - offset (article 3.2.2, r_F) at the pose
/// `T_anchor_body`, with the Geman-McClure loss: a pair k sigmas off has weight
/// (c^2 / (c^2 + k^2))^2, where c = `robust_scale`. Partial sums of fixed chunks are added in
/// order: the bits do not depend on the number of threads.
NormalEquations linearise(const Correspondences& pairs, const SE3& T_anchor_body,
                          double robust_scale, WorkerPool& pool,
                          std::vector<NormalEquations>& partials);

}  // namespace holdfast::registration
