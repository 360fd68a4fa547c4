#pragma once

#include "simulation/wayfinding/ground.hpp"

namespace holdfast::simulation {

/// Where one may drive in a map whose ground was taken out, as many maps for driving have it: free
/// space between things. Its height is that of the lowest things around (a fifth of those within 14
/// m are lower), smoothed over some 50 m. A cell is free when nothing stands between 0.3 and 2 m
/// above that, and counts when things stand within 25 m in at least 10 of 16 directions, so that
/// the robot stays where the map was made and does not go round the outside of it.
Ground find_walled_space(const World& world, const RobotReach& reach);

}  // namespace holdfast::simulation
