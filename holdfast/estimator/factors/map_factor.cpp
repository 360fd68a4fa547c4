#include "holdfast/estimator/factors/map_factor.hpp"

namespace holdfast::estimator {

using registration::kPosition;
using registration::kRotation;
using registration::kVelocity;

static_assert(int{kPosition} == NodeState::kP && int{kRotation} == NodeState::kR &&
              int{kVelocity} == NodeState::kV);

MapFactor::MapFactor(const registration::NormalEquations& equations, const NodeState& at)
    : T_map_body_(at.T_map_body),
      v_map_(at.v_map),
      H_(equations.H),
      g_(equations.g),
      cost_(equations.cost) {}

void MapFactor::add_to(const NodeState& x, NodeBlock& out, double& cost) const {
  Vector9d e;
  e.segment<3>(kPosition) = x.T_map_body.translation - T_map_body_.translation;
  e.segment<3>(kRotation) = so3::log(T_map_body_.rotation.conjugate() * x.T_map_body.rotation);
  e.segment<3>(kVelocity) = x.v_map - v_map_;
  const Eigen::Matrix3d J = chart_jacobian(e.segment<3>(kRotation));
  const Vector9d He = H_ * e;
  Vector9d gradient = g_ + He;
  gradient.segment<3>(kRotation) = J.transpose() * gradient.segment<3>(kRotation).eval();
  Matrix9d H = H_;
  H.middleCols<3>(kRotation) = H_.middleCols<3>(kRotation) * J;
  H.middleRows<3>(kRotation) = J.transpose() * H.middleRows<3>(kRotation).eval();
  out.H.topLeftCorner<9, 9>() += H;
  out.g.head<9>() += gradient;
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
