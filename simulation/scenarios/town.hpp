#pragma once

#include <string_view>

#include "holdfast/core/result.hpp"
#include "simulation/scenario.hpp"

namespace holdfast::simulation {

inline constexpr double kTownKm2 = 0.1;        ///< of plain `town`
inline constexpr double kSmallestTown = 0.03;  ///< km^2
inline constexpr double kLargestTown = 10;

/// A town of about `size_km2`: streets in a grid of uneven meshes, in each a block of houses unlike
/// any other, parked cars, trees, lamp posts, and traffic. Each block is drawn from its column and
/// row alone, so that a larger town contains a smaller one. The way loops through its first
/// streets, at most some 6 km of them. About 4000 triangles a block of 75 x 70 m.
Scenario make_town(double size_km2);

/// `town` or, with its size, `town:2km2`. Error: a size that is none, or not within the limits.
Result<Scenario> make_town(std::string_view name);

}  // namespace holdfast::simulation
