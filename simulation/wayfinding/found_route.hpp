#pragma once

#include "holdfast/core/result.hpp"
#include "simulation/motion/route.hpp"
#include "simulation/world/world.hpp"

namespace holdfast::simulation {

/// A way through a world that nobody has laid out.
struct FoundRoute {
  Route route;
  double length_m = 0;
  double shared_share = 0;  ///< of the way back, less than 1 m from the way out
  bool on_ground = true;    ///< false: over ground that the world does not have
};

/// Finds the long way through a world: from one end of the largest connected drivable ground
/// (ground.hpp) to its other end and back, as a closed route.
///
/// The ends are the two cells whose shortest way is longest (found by a double sweep: the farthest
/// cell from the one nearest to the middle, and the farthest from that). Out and back are cheapest
/// ways, where a metre costs more the closer things stand (up to 3 times within 2 m), and on the
/// way back also up to 4 times as much within 5 m of the way out: it is another way wherever there
/// is one, else the same. Both keep 0.6 m to their right where there is room, so that a shared way
/// has two lanes and its end a turning circle. The way is smoothed without coming closer to things
/// than the robot's radius, and takes its heights from the ground, averaged over 4 m.
///
/// Where the ground leads less than 60 m on, and the space between things (walled_space.hpp) four
/// times as far, the ground was taken out of the map and that space is used.
///
/// Deterministic. Takes some seconds for a square kilometre. Error: no closed way of 8 m.
Result<FoundRoute> find_route(const World& world);

}  // namespace holdfast::simulation
