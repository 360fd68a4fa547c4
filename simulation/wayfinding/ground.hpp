#pragma once

#include <vector>

#include "simulation/wayfinding/grid.hpp"
#include "simulation/world/world.hpp"

namespace holdfast::simulation {

/// What a robot can drive over.
struct RobotReach {
  double radius_m = 0.6;      ///< of the robot and its weaving
  double headroom_m = 1.6;    ///< nothing hangs lower
  double most_step_m = 0.15;  ///< from one cell to the next
  double most_slope = 0.25;   ///< rise over length, over a metre
  double low_m = 0.25;        ///< what is lower than this over the ground is part of it
};

/// The ground of a world: in each cell the lowest surface with head room above it.
struct Ground {
  Grid grid;
  std::vector<float> height;  ///< of each cell, metres; NaN where there is none
  std::vector<float> room;    ///< metres to the nearest cell that cannot be driven over
  std::vector<bool> usable;   ///< the largest set of cells, connected, where the robot fits

  /// Free room about a place, 0 outside.
  double room_at(const Eigen::Vector2d& p) const;
  /// Height at a place: the mean of the ground within `radius` metres that is not more than a step
  /// off the nearest.
  double height_at(const Eigen::Vector2d& p, double radius) const;
};

/// Finds it in the world's triangles (sampled each half cell) and discs (their centres). Cells are
/// 0.25 m wide, larger only where that would make more than 20 million. A cell without a surface
/// takes the height of its neighbours when five of them have one. What is below the back of a
/// triangle is within a solid, and no ground. A part from most of whose rim it goes down by more
/// than a metre is a roof, which counts for a twentieth of its size. No ground at all: no cell is
/// usable.
Ground find_ground(const World& world, const RobotReach& reach);

}  // namespace holdfast::simulation
