#pragma once

#include "holdfast/estimator/factors/quadratic.hpp"

namespace holdfast::estimator {

/// What is known of the oldest node: a quadratic of all its unknowns at a linearisation point, from
/// a start with its covariance or from marginalisation.
class PriorFactor {
 public:
  PriorFactor() = default;
  /// A Gaussian about `mean`; the covariance must be positive definite.
  PriorFactor(const NodeState& mean, const Matrix18d& covariance);
  /// cost(at [+] d) = cost + 2 g.d + d.H d.
  PriorFactor(const NodeState& at, const NodeBlock& quadratic, double cost);

  /// Cost at `x`, and its gradient and curvature.
  void add_to(const NodeState& x, NodeBlock& out, double& cost) const;

 private:
  NodeState at_;
  NodeBlock quadratic_;
  double cost_ = 0;
};

}  // namespace holdfast::estimator
