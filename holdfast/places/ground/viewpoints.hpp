#pragma once

#include <vector>

#include "holdfast/places/ground/standing_room.hpp"

namespace holdfast::places {

/// Chooses floor positions about `spacing_m` apart, in the middle of free room before near its rim.
/// `room` is that of a whole map, in any order; pieces of it that cannot be reached from the others
/// by steps of 0.3 m are left out if they are small (table tops, roofs of cars). Same room, same
/// choice. Positions count from the map's origin.
std::vector<Eigen::Vector3f> choose_viewpoints(std::vector<Standing> room, float spacing_m);

}  // namespace holdfast::places
