#include "holdfast/pipeline/graph/placement.hpp"

namespace holdfast::pipeline {
namespace {

using estimator::Matrix18d;
using estimator::NodeState;

constexpr double kInflation = 4.0;         // of the odometry's variances: twice its sigmas
constexpr double kLeastSpeedSigma = 0.05;  // m/s
constexpr double kLeastPositionSigma = 0.02;
constexpr double kLeastRotationSigma = 0.003;

void add_to_diagonal(Matrix18d& P, int block, double sigma) {
  P.diagonal().segment<3>(block).array() += sigma * sigma;
}

}  // namespace

PlacedNode place_node(const Placement& found, const filter::FilterState& odometry,
                      const Eigen::Vector3d& gravity_map, double gravity_sigma_m_s2) {
  const Eigen::Quaterniond q_map_odom =
      found.T_map_body.rotation * odometry.T_map_body.rotation.conjugate();
  const Eigen::Matrix3d R_map_odom = q_map_odom.toRotationMatrix();
  const Eigen::Matrix3d R_map_body = found.T_map_body.rotation.toRotationMatrix();
  PlacedNode node;
  node.x = {odometry.t,          found.T_map_body,   R_map_odom * odometry.v_map,
            odometry.accel_bias, odometry.gyro_bias, gravity_map};
  node.P = Matrix18d::Zero();
  node.P.topLeftCorner<6, 6>() = found.covariance;
  add_to_diagonal(node.P, NodeState::kP, kLeastPositionSigma);
  add_to_diagonal(node.P, NodeState::kR, kLeastRotationSigma);
  const auto of_odometry = [&](int block) {
    return kInflation * odometry.P.block<3, 3>(block, block);
  };
  // A velocity turns with the heading that was found.
  const double turned = node.x.v_map.norm() * std::sqrt(found.covariance.diagonal()[5]);
  node.P.block<3, 3>(NodeState::kV, NodeState::kV) =
      R_map_odom * of_odometry(NodeState::kV) * R_map_odom.transpose();
  add_to_diagonal(node.P, NodeState::kV, kLeastSpeedSigma + turned);
  node.P.block<3, 3>(NodeState::kBa, NodeState::kBa) = of_odometry(NodeState::kBa);
  node.P.block<3, 3>(NodeState::kBg, NodeState::kBg) = of_odometry(NodeState::kBg);
  add_to_diagonal(node.P, NodeState::kBa, gravity_sigma_m_s2);
  add_to_diagonal(node.P, NodeState::kG, gravity_sigma_m_s2);
  const double variance = gravity_sigma_m_s2 * gravity_sigma_m_s2;
  node.P.block<3, 3>(NodeState::kBa, NodeState::kG) = variance * R_map_body.transpose();
  node.P.block<3, 3>(NodeState::kG, NodeState::kBa) = variance * R_map_body;
  return node;
}

}  // namespace holdfast::pipeline
