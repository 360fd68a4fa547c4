#pragma once

#include "holdfast/estimator/node_state.hpp"
#include "holdfast/filter/filter_state.hpp"

namespace holdfast::pipeline {

/// A pose in the map that was found by other means than tracking.
struct Placement {
  SE3 T_map_body;  ///< at the time of the odometry's newest state
  /// In the order of StepReport::pose_covariance.
  estimator::Matrix6d covariance = estimator::Matrix6d::Identity();
};

/// A node of the graph and its covariance.
struct PlacedNode {
  estimator::NodeState x;
  estimator::Matrix18d P;
};

/// The node with which a graph goes on from `found` (article 3.4.2 resets the biases; ours keeps
/// biases, tilt and velocity of the odometry, with wider covariances, and takes position and yaw
/// from the search). `odometry` is its newest state, with T_odom_body in place of T_map_body; it
/// took gravity for known, so that its bias of the accelerometer holds the error of both.
PlacedNode place_node(const Placement& found, const filter::FilterState& odometry,
                      const Eigen::Vector3d& gravity_map, double gravity_sigma_m_s2);

}  // namespace holdfast::pipeline
