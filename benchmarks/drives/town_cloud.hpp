#pragma once

#include <memory>

#include "holdfast/io/point_cloud.hpp"
#include "simulation/simulation.hpp"

namespace holdfast::benchmarks {

/// Surveys of several worlds side by side, in their own density, until there are `points`: the
/// warehouse at its own place, then corridor, office and hall in turn, each surveyed with another
/// seed, on a grid of 55 m to the east of it. The last world is cut off where the count is reached.
Result<io::PointCloud> make_town(std::size_t points, simulation::Simulation& warehouse,
                                 int threads);

}  // namespace holdfast::benchmarks
