#pragma once

#include "holdfast/filter/filter_state.hpp"

namespace holdfast::filter {

/// A robot that stood still at the start stands still until its IMU feels it start. Where the scene
/// determines a direction badly, nothing else tells it from one that glides evenly, and the biases
/// would follow the noise of scans.
class Rest {
 public:
  void begin() { rests_ = true; }
  void end() { rests_ = false; }
  bool is_assumed() const { return rests_; }

  /// Compares the readings of a scan (body frame) with those so far. A start is felt from
  /// 0.05 m/s^2 or 0.01 rad/s on.
  bool holds(const preprocess::ImuSegment& imu);

  /// The correction of `state` by the knowledge that it stands still; returns the share of its
  /// errors that is left, I - K H.
  static Matrix15d correct(FilterState& state);

 private:
  bool rests_ = false;
  double scans_ = 0;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();
};

}  // namespace holdfast::filter
