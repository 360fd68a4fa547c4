#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulation/sensors/lidar/lidar_model.hpp"

namespace holdfast::simulation {

/// The LiDAR with what its calibration left, drawn once for each beam by the sizes in its faults
/// (streams "lidar.beam_offset" and "lidar.beam_angle" of `seed`). Where a size is 0 the beams keep
/// what they have.
LidarModel with_beam_errors(LidarModel model, std::uint64_t seed);

/// Where the rays really point whose returns the LiDAR places along its calibrated beams.
class TrueDirections {
 public:
  explicit TrueDirections(const LidarModel& model);

  /// All beams point where they should.
  bool as_stated() const { return as_stated_; }

  /// `stated`: unit, in the lidar frame, of a beam by its ring. Unchanged for beams without errors
  /// and rings that the LiDAR does not have.
  Eigen::Vector3d of(const Eigen::Vector3d& stated, std::uint16_t ring) const;

 private:
  std::vector<BeamError> by_ring_;
  bool as_stated_ = true;
};

}  // namespace holdfast::simulation
