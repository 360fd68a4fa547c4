#include "holdfast/estimator/factors/between_factor.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace holdfast::estimator {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Loss {
  double cost;
  double slope;  ///< d cost / d k^2
};

Loss evaluate(RobustLoss loss, double scale, double squared) {
  const double c2 = scale * scale;
  if (loss == RobustLoss::kHuber && squared > c2) {
    const double k = std::sqrt(squared);
    return {2 * scale * k - c2, scale / k};
  }
  if (loss == RobustLoss::kGemanMcClure) {
    const double share = c2 / (c2 + squared);
    return {share * squared, share * share};
  }
  return {squared, 1.0};
}

}  // namespace

BetweenFactor::BetweenFactor(const OdometryIncrement& increment, RobustLoss loss, double scale)
    : measured_(increment.T_prev_cur), loss_(loss), scale_(scale) {
  const Eigen::LLT<Matrix6d> llt(increment.covariance);
  whitening_ = llt.matrixL().solve(Matrix6d::Identity());
}

BetweenFactor BetweenFactor::printed(const SE3& T_odom_i, const SE3& T_odom_j,
                                     const PrintedWeights& weights) {
  BetweenFactor factor;
  factor.is_printed_ = true;
  factor.measured_ = T_odom_j * T_odom_i.inverse();
  factor.weights_ = weights;
  return factor;
}

BetweenFactor::Linearised BetweenFactor::linearise_in_body(const NodeState& i,
                                                           const NodeState& j) const {
  const Eigen::Quaterniond R_body_map = i.T_map_body.rotation.conjugate();
  const Matrix3d R_t = R_body_map.toRotationMatrix();
  const Vector3d position = R_t * (j.T_map_body.translation - i.T_map_body.translation);
  const Eigen::Quaterniond turned = R_body_map * j.T_map_body.rotation;
  const Vector3d rotation = so3::log(measured_.rotation.conjugate() * turned);
  const Matrix3d J_inverse = so3::right_jacobian_inverse(rotation);
  Linearised out;
  out.residual.head<3>() = position - measured_.translation;
  out.residual.tail<3>() = rotation;
  out.J_i << -R_t, so3::hat(position), Matrix3d::Zero(),
      -J_inverse * turned.conjugate().toRotationMatrix();
  out.J_j << R_t, Matrix3d::Zero(), Matrix3d::Zero(), J_inverse;
  return out;
}

BetweenFactor::Linearised BetweenFactor::linearise_in_world(const NodeState& i,
                                                            const NodeState& j) const {
  const Eigen::Quaterniond turn = j.T_map_body.rotation * i.T_map_body.rotation.conjugate();
  const Vector3d lever =
      i.T_map_body.translation + measured_.rotation.conjugate() * measured_.translation;
  const Vector3d lever_body = i.T_map_body.rotation.conjugate() * lever;
  const Vector3d rotation = so3::log(turn * measured_.rotation.conjugate());
  const Matrix3d by_turn = so3::right_jacobian_inverse(rotation) *
                           (measured_.rotation * i.T_map_body.rotation).toRotationMatrix();
  const Matrix3d by_lever = j.T_map_body.rotation.toRotationMatrix() * so3::hat(lever_body);
  Linearised out;
  out.residual.head<3>() = j.T_map_body.translation - turn * lever;
  out.residual.tail<3>() = rotation;
  out.J_i << -turn.toRotationMatrix(), -by_lever, Matrix3d::Zero(), -by_turn;
  out.J_j << Matrix3d::Identity(), by_lever, Matrix3d::Zero(), by_turn;
  return out;
}

BetweenFactor::Linearised BetweenFactor::linearise(const NodeState& i, const NodeState& j) const {
  return is_printed_ ? linearise_in_world(i, j) : linearise_in_body(i, j);
}

double BetweenFactor::squared_distance(const NodeState& i, const NodeState& j) const {
  return (whitening_ * linearise(i, j).residual).squaredNorm();
}

void BetweenFactor::add_to(const NodeState& i, const NodeState& j, const PairBlocks& out) const {
  const Linearised l = linearise(i, j);
  Vector6d r = whitening_ * l.residual;
  double slope;
  if (is_printed_) {
    const bool differs =
        r.head<3>().norm() > weights_.largest_m || r.tail<3>().norm() > weights_.largest_rad;
    slope = differs ? weights_.differing : weights_.agreeing;
  } else {
    const double squared = r.squaredNorm();
    const Loss loss = evaluate(loss_, scale_, squared);
    slope = loss.slope;
    out.cost += loss.cost - slope * squared;  // add_whitened adds the other part
  }
  const double root = std::sqrt(slope);
  const Jacobian W = root * whitening_;
  r *= root;
  add_whitened<6, 6, 6>(r, W * l.J_i, W * l.J_j, out);
}

}  // namespace holdfast::estimator
