#include "holdfast/estimator/factors/map_factor.hpp"

namespace holdfast::estimator {

using registration::kPosition;
using registration::kRotation;
using registration::kVelocity;

static_assert(int{kPosition} == NodeState::kP && int{kRotation} == NodeState::kR &&
              int{kVelocity} == NodeState::kV);

MapFactor::MapFactor(const registration::NormalEquations& equations, const NodeState& at)
    : at_(at), cost_(equations.cost) {
  H_.topLeftCorner<9, 9>() = equations.H;
  g_.head<9>() = equations.g;
}

MapFactor::MapFactor(const Matrix15d& H, const Vector15d& g, double cost, const NodeState& at)
    : at_(at), H_(H), g_(g), cost_(cost) {}

void MapFactor::add_to(const NodeState& x, NodeBlock& out, double& cost) const {
  const Vector15d e = x.minus(at_).head<15>();
  const Eigen::Matrix3d J = chart_jacobian(e.segment<3>(kRotation));
  const Vector15d He = H_ * e;
  Vector15d gradient = g_ + He;
  gradient.segment<3>(kRotation) = J.transpose() * gradient.segment<3>(kRotation).eval();
  Matrix15d H = H_;
  H.middleCols<3>(kRotation) = H_.middleCols<3>(kRotation) * J;
  H.middleRows<3>(kRotation) = J.transpose() * H.middleRows<3>(kRotation).eval();
  out.H.topLeftCorner<15, 15>() += H;
  out.g.head<15>() += gradient;
  cost += cost_ + e.dot(2 * g_ + He);
}

MapFactor MapFactor::scaled(double weight) const {
  MapFactor result = *this;
  result.H_ *= weight;
  result.g_ *= weight;
  result.cost_ *= weight;
  return result;
}

}  // namespace holdfast::estimator
