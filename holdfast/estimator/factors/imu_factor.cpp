#include "holdfast/estimator/factors/imu_factor.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace holdfast::estimator {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Walks of zero would make a node's bias the same unknown as the last one's; the floor is far below
// what matters and far above what double precision loses in an elimination.
constexpr double kLeastWalk = 1e-7;

void add_walk(int at, double sigma, const Vector3d& moved, const PairBlocks& out) {
  const double floored = std::max(sigma, kLeastWalk);
  const double w = 1.0 / (floored * floored);
  for (int a = at; a < at + 3; ++a) {
    out.i.H(a, a) += w;
    out.j.H(a, a) += w;
    out.H_ij(a, a) -= w;
  }
  out.i.g.segment<3>(at) -= w * moved;
  out.j.g.segment<3>(at) += w * moved;
  out.cost += w * moved.squaredNorm();
}

}  // namespace

void ImuFactor::set(const WalkSigmas& walk) {
  walk_ = walk;
  weight_.reset();
  whiten_by_covariance();
}

void ImuFactor::set_weight(double weight) {
  weight_ = weight;
  whitening_ = std::sqrt(weight) * Matrix9d::Identity();
}

void ImuFactor::whiten_by_covariance() {
  const Eigen::LLT<Matrix9d> llt(preintegration.covariance());
  whitening_ = llt.matrixL().solve(Matrix9d::Identity());
}

void ImuFactor::rebase(const NodeState& i) {
  if (preintegration.rebase(i.accel_bias, i.gyro_bias) && !weight_) whiten_by_covariance();
}

ImuFactor::Linearised ImuFactor::linearise(const NodeState& i, const NodeState& j) const {
  enum Row : int { kP = 0, kR = 3, kV = 6 };
  const double dt = preintegration.seconds();
  const MotionIncrement d = preintegration.corrected(i.accel_bias, i.gyro_bias);
  const Eigen::Quaterniond R_body_map = i.T_map_body.rotation.conjugate();
  const Matrix3d R_t = R_body_map.toRotationMatrix();
  const Vector3d position = R_t * (j.T_map_body.translation - i.T_map_body.translation -
                                   dt * i.v_map - 0.5 * dt * dt * i.gravity_map);
  const Vector3d velocity = R_t * (j.v_map - i.v_map - dt * i.gravity_map);
  const Eigen::Quaterniond turned = R_body_map * j.T_map_body.rotation;

  Linearised out;
  const Vector3d rotation = so3::log(d.rotation.conjugate() * turned);
  out.residual.segment<3>(kP) = position - d.position;
  out.residual.segment<3>(kR) = rotation;
  out.residual.segment<3>(kV) = velocity - d.velocity;

  out.J_i.setZero();
  out.J_j.setZero();
  const Matrix3d J_inverse = so3::right_jacobian_inverse(rotation);
  out.J_i.block<3, 3>(kP, NodeState::kP) = -R_t;
  out.J_i.block<3, 3>(kP, NodeState::kR) = so3::hat(position);
  out.J_i.block<3, 3>(kP, NodeState::kV) = -dt * R_t;
  out.J_i.block<3, 3>(kP, NodeState::kG) = -0.5 * dt * dt * R_t;
  out.J_i.block<3, 3>(kR, NodeState::kR) = -J_inverse * turned.conjugate().toRotationMatrix();
  out.J_i.block<3, 3>(kV, NodeState::kR) = so3::hat(velocity);
  out.J_i.block<3, 3>(kV, NodeState::kV) = -R_t;
  out.J_i.block<3, 3>(kV, NodeState::kG) = -dt * R_t;
  out.J_j.block<3, 3>(kP, NodeState::kP) = R_t;
  out.J_j.block<3, 3>(kR, NodeState::kR) = J_inverse;
  out.J_j.block<3, 3>(kV, NodeState::kV) = R_t;

  // Biases: positions and velocities are linear in them, rotation as in Forster, appendix, A.19.
  const Preintegration::BiasJacobian& B = preintegration.bias_jacobian();
  out.J_i.block<9, 6>(0, NodeState::kBa) = -B;
  const Matrix3d by_gyro = B.block<3, 3>(kR, 3);
  const Vector3d correction = by_gyro * (i.gyro_bias - preintegration.gyro_bias());
  out.J_i.block<3, 3>(kR, NodeState::kBg) = -J_inverse * so3::exp(-rotation).toRotationMatrix() *
                                            so3::right_jacobian(correction) * by_gyro;
  return out;
}

void ImuFactor::add_to(const NodeState& i, const NodeState& j, const PairBlocks& out) const {
  const Linearised l = linearise(i, j);
  const Vector9d r = whitening_ * l.residual;
  const Jacobian18 J_i = whitening_ * l.J_i;
  const Jacobian9 J_j = whitening_ * l.J_j;
  add_whitened<9, 18, 9>(r, J_i, J_j, out);
  add_walk(NodeState::kBa, walk_.accel_bias, j.accel_bias - i.accel_bias, out);
  add_walk(NodeState::kBg, walk_.gyro_bias, j.gyro_bias - i.gyro_bias, out);
  add_walk(NodeState::kG, walk_.gravity, j.gravity_map - i.gravity_map, out);
}

}  // namespace holdfast::estimator
