#include "simulation/sensors/lidar/beam_errors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "holdfast/core/random.hpp"

namespace holdfast::simulation {

using Eigen::Vector3d;

LidarModel with_beam_errors(LidarModel model, std::uint64_t seed) {
  const LidarFaults& faults = model.faults;
  const double angle_rad = faults.beam_angle_sigma_deg * std::numbers::pi / 180;
  RandomStream offsets(seed, "lidar.beam_offset");
  RandomStream angles(seed, "lidar.beam_angle");
  for (LidarBeam& beam : model.beams) {
    BeamError& error = beam.error;
    if (faults.beam_offset_sigma_m > 0) {
      error.range_m = faults.beam_offset_sigma_m * offsets.normal();
    }
    if (angle_rad == 0) continue;
    error.elevation_rad = angle_rad * angles.normal();
    error.azimuth_rad = angle_rad * angles.normal();
  }
  return model;
}

TrueDirections::TrueDirections(const LidarModel& model) {
  for (const LidarBeam& beam : model.beams) {
    if (by_ring_.size() <= beam.ring) by_ring_.resize(beam.ring + std::size_t{1});
    by_ring_[beam.ring] = beam.error;
    as_stated_ = as_stated_ && !beam.error.turns();
  }
}

Vector3d TrueDirections::of(const Vector3d& stated, std::uint16_t ring) const {
  if (ring >= by_ring_.size() || !by_ring_[ring].turns()) return stated;
  const BeamError& error = by_ring_[ring];
  const double azimuth = std::atan2(stated.y(), stated.x()) + error.azimuth_rad;
  const double elevation = std::asin(std::clamp(stated.z(), -1.0, 1.0)) + error.elevation_rad;
  const double level = std::cos(elevation);
  return {level * std::cos(azimuth), level * std::sin(azimuth), std::sin(elevation)};
}

}  // namespace holdfast::simulation
