#pragma once

#include <filesystem>

#include "holdfast/core/result.hpp"
#include "simulation/scenario.hpp"

namespace holdfast::benchmarks {

/// A world that is a large point cloud, and what it took to make it.
struct CloudScenario {
  simulation::Scenario scenario;
  std::filesystem::path file;  ///< empty: made up
  double discs_s = 0;          ///< wall time: discs from the points
  double way_s = 0;            ///< and a way through them
};

/// The campus below $HOLDFAST_DATA (utd_campus_west/map.pcd) where it is installed, or else
/// points about 0.2 m apart, with 3 cm of noise, on the ground and the walls of a town of 48
/// blocks: some three million discs either way.
Result<CloudScenario> make_cloud_scenario(int threads);

/// The same from these points.
Result<CloudScenario> cloud_scenario_of(const std::vector<Eigen::Vector3f>& points, int threads);

/// Points of a town of `columns` x `rows` blocks.
std::vector<Eigen::Vector3f> block_town(int columns, int rows);

}  // namespace holdfast::benchmarks
