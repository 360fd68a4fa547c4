#include "holdfast/estimator/factors/prior_factor.hpp"

#include <Eigen/Cholesky>

namespace holdfast::estimator {

PriorFactor::PriorFactor(const NodeState& mean, const Matrix18d& covariance) : at_(mean) {
  quadratic_.H = covariance.llt().solve(Matrix18d::Identity());
  quadratic_.H = (0.5 * (quadratic_.H + quadratic_.H.transpose())).eval();
}

PriorFactor::PriorFactor(const NodeState& at, const NodeBlock& quadratic, double cost)
    : at_(at), quadratic_(quadratic), cost_(cost) {}

void PriorFactor::add_to(const NodeState& x, NodeBlock& out, double& cost) const {
  constexpr int kR = NodeState::kR;
  const Vector18d e = x.minus(at_);
  const Eigen::Matrix3d J = chart_jacobian(e.segment<3>(kR));
  const Vector18d He = quadratic_.H * e;
  Vector18d gradient = quadratic_.g + He;
  gradient.segment<3>(kR) = J.transpose() * gradient.segment<3>(kR).eval();
  Matrix18d H = quadratic_.H;
  H.middleCols<3>(kR) = quadratic_.H.middleCols<3>(kR) * J;
  H.middleRows<3>(kR) = J.transpose() * H.middleRows<3>(kR).eval();
  out.H += H;
  out.g += gradient;
  cost += cost_ + e.dot(2 * quadratic_.g + He);
}

}  // namespace holdfast::estimator
