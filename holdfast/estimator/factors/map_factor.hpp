#pragma once

#include "holdfast/estimator/factors/quadratic.hpp"
#include "holdfast/registration/normal_equations.hpp"

namespace holdfast::estimator {

/// What a scan says about [p, R, v] of its node, as the quadratic that its residuals form at the
/// state where they were linearised (article 3.2.2, 3.3.2: w_E r_E^2 + w_F r_F^2). The newest node
/// gets a new one in each iteration, older ones keep their last.
class MapFactor {
 public:
  MapFactor() = default;
  /// `at`: the state at which `equations` were linearised.
  MapFactor(const registration::NormalEquations& equations, const NodeState& at);

  /// Cost at `x`, and its gradient and curvature.
  void add_to(const NodeState& x, NodeBlock& out, double& cost) const;

  /// The same with another weight on the squared norms.
  MapFactor scaled(double weight) const;

  const Matrix9d& H() const { return H_; }

 private:
  SE3 T_map_body_;
  Eigen::Vector3d v_map_ = Eigen::Vector3d::Zero();
  Matrix9d H_ = Matrix9d::Zero();
  Vector9d g_ = Vector9d::Zero();
  double cost_ = 0;
};

}  // namespace holdfast::estimator
