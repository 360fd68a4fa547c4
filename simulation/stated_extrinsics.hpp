#pragma once

#include <cstdint>

#include "holdfast/core/se3.hpp"

namespace holdfast::simulation {

/// How far the extrinsics that a robot's configuration states are from where its LiDAR is.
struct ExtrinsicsError {
  double position_m = 0;
  double angle_rad = 0;

  bool is_none() const { return position_m == 0 && angle_rad == 0; }

  /// 1 cm and 0.3 degrees, as measured by hand with a tape and by eye. Chosen, without a source.
  static ExtrinsicsError by_hand();
};

/// The T_body_lidar that is stated: the true one times an error of exactly these sizes, with
/// directions drawn from the stream "config.extrinsics".
SE3 stated_extrinsics(const SE3& T_body_lidar, const ExtrinsicsError& error, std::uint64_t seed);

}  // namespace holdfast::simulation
