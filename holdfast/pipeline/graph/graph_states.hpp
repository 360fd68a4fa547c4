#pragma once

#include "holdfast/estimator/node_state.hpp"
#include "holdfast/filter/filter_state.hpp"
#include "holdfast/filter/matching/scan_match.hpp"

/// A node of the graph as the filter and the matching know states.
namespace holdfast::pipeline {

inline estimator::NodeState node_of(const filter::FilterState& s, const Eigen::Vector3d& gravity) {
  return {s.t, s.T_map_body, s.v_map, s.accel_bias, s.gyro_bias, gravity};
}

inline filter::FilterState filter_state_of(const estimator::NodeState& x,
                                           const estimator::Matrix18d& P) {
  return {x.t, x.T_map_body, x.v_map, x.accel_bias, x.gyro_bias, P.topLeftCorner<15, 15>()};
}

inline filter::MatchState match_state_of(const estimator::NodeState& x) {
  return {x.T_map_body, x.v_map, x.accel_bias, x.gyro_bias, x.gravity_map};
}

}  // namespace holdfast::pipeline
