#pragma once

#include "holdfast/estimator/factors/quadratic.hpp"
#include "holdfast/filter/filter_state.hpp"
#include "holdfast/registration/normal_equations.hpp"

namespace holdfast::estimator {

using filter::Matrix15d;
using filter::Vector15d;

/// What a scan says about [p, R, v, b_a, b_g] of its node (velocity and biases by the skew of its
/// points), as the quadratic that its residuals form at the state where they were linearised
/// (article 3.2.2, 3.3.2: w_E r_E^2 + w_F r_F^2). The newest node gets a new one in each iteration,
/// older ones keep their last.
class MapFactor {
 public:
  MapFactor() = default;
  /// `at`: the state at which `equations` were linearised.
  MapFactor(const registration::NormalEquations& equations, const NodeState& at);
  /// cost(at [+] d) = cost + 2 g.d + d.H d, with d as in filter::FilterState.
  MapFactor(const Matrix15d& H, const Vector15d& g, double cost, const NodeState& at);

  /// Cost at `x`, and its gradient and curvature.
  void add_to(const NodeState& x, NodeBlock& out, double& cost) const;

  /// The same with another weight on the squared norms.
  MapFactor scaled(double weight) const;

  const Matrix15d& H() const { return H_; }

 private:
  NodeState at_;
  Matrix15d H_ = Matrix15d::Zero();
  Vector15d g_ = Vector15d::Zero();
  double cost_ = 0;
};

}  // namespace holdfast::estimator
