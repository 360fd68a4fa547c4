#pragma once

#include "simulation/world/world_builder.hpp"

namespace holdfast::simulation {

/// One mesh of a town's grid: a block of houses, and the streets along its western and southern
/// sides. All in metres.
struct TownBlock {
  int column = 0;
  int row = 0;
  Eigen::Vector2d min{0, 0};  ///< crossing of the middles of the streets south-west of it
  Eigen::Vector2d max{0, 0};  ///< of those north-east of it
};

/// Across a street, from its middle: lane, strip for bicycles, parked cars, pavement, houses.
inline constexpr double kLaneMiddle = 1.75;
inline constexpr double kStripMiddle = 4.5;
inline constexpr double kParkingMiddle = 6.6;
inline constexpr double kHouseLine = 10;

/// Builds the block, its pavements and its half of the streets; its looks depend on column and row
/// only. Cars and crates are objects, a few of them spare.
void add_town_block(WorldBuilder& build, const TownBlock& block);

}  // namespace holdfast::simulation
