#pragma once

#include <cstdint>

#include "simulation/motion/drive.hpp"
#include "simulation/motion/trajectory.hpp"

namespace holdfast::simulation {

/// What a person who walks adds to the motion of what is held in the hands: the heave and sway of
/// steps, and quick turns there and back, one every four seconds about yaw, pitch and roll in turn.
class Gait {
 public:
  Gait(const DriveStyle& style, std::uint64_t seed);

  /// Changes the control pose of time `t` (seconds from the start of the log); `moving` is 0 at
  /// rest and 1 on the move.
  void add(double t, double moving, PoseVector& control) const;

 private:
  double gesture(std::uint64_t index, double since) const;

  double heave_m_;
  double sway_m_;
  double gesture_rad_;
  double gesture_rad_s_;
  std::uint64_t seed_;
  double steps_hz_;
  double phase_;
};

}  // namespace holdfast::simulation
