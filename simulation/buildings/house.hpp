#pragma once

#include "simulation/world/world_builder.hpp"

namespace holdfast::simulation {

/// A house over a rectangle: four facades with rows of windows, doors and pillars, seen from
/// outside. `variant` draws how they are laid out: another number, another house.
struct HousePlan {
  Eigen::Vector2d min{0, 0};
  Eigen::Vector2d max{10, 10};
  double ground = 0;         ///< height of its foot
  double height = 9;         ///< from its foot to the roof
  double storey = 3.2;       ///< height of each row of windows
  double window_step = 3.1;  ///< metres from window to window, more or less
  double window_depth = 0.2;
  int pillars = 2;               ///< on each facade, about
  int detailed_storeys = 2;      ///< above these facades are plain
  unsigned detailed_sides = 15;  ///< bits: west 1, north 2, east 4, south 8; others are plain
  unsigned variant = 0;
  Material material = materials::kBrick;
};

/// Walls, roof, pillars and steps before doors; none of them is an object.
void add_house(WorldBuilder& build, const HousePlan& plan);

}  // namespace holdfast::simulation
