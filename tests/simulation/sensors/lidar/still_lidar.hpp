#pragma once

#include <cmath>
#include <numbers>

#include "simulation/scenario.hpp"
#include "simulation/world/world_builder.hpp"
#include "tests/simulation/support.hpp"
#include "tests/simulation/tolerances.hpp"

/// A LiDAR that stands still in a small world with a closed form.
namespace holdfast::simulation::testing {

/// A room of 12 x 8 x 4 m with a corner at the origin, as the scenario "box"; the wall at x = 12 is
/// of `material`.
inline World room_with_wall(const Material& material) {
  WorldBuilder build;
  const Material& other = materials::kIdeal;
  build.floor({0, 0}, {12, 8}, 0, other);
  build.ceiling({0, 0}, {12, 8}, 4, other);
  build.wall({{0, 0}, {12, 0}, 0, 4, other, {}});
  build.wall({{12, 0}, {12, 8}, 0, 4, material, {}});
  build.wall({{12, 8}, {0, 8}, 0, 4, other, {}});
  build.wall({{0, 8}, {0, 0}, 0, 4, other, {}});
  return build.build();
}

/// A world in which the robot rests within a few centimetres of `at`, the LiDAR (mounted without a
/// lever) `at.z()` above the ground.
inline Scenario still_at(const Eigen::Vector3d& at, World world) {
  Scenario scenario;
  scenario.name = "still";
  scenario.world = std::move(world);
  const Eigen::Vector2d p = at.head<2>();
  scenario.route =
      Route::closed({p, p + Eigen::Vector2d(0.04, 0), p + Eigen::Vector2d(0.04, 0.04)}, 0.01);
  scenario.style.rest_s = 1000;
  scenario.style.weave_m = 0;
  scenario.style.body_height_m = at.z();
  return scenario;
}

/// Nothing is lost or noisy but by what `options` add.
inline SimulationOptions still_options(double duration_s) {
  SimulationOptions options = noise_free("", duration_s);
  options.lidar.T_body_lidar = SE3();
  options.lidar.keep_all_returns = true;
  return options;
}

inline std::unique_ptr<Simulation> make(Scenario scenario, const SimulationOptions& options) {
  auto simulation = Simulation::create(std::move(scenario), options);
  if (simulation) return std::move(*simulation);
  ADD_FAILURE() << simulation.error().message;
  std::abort();
}

/// A return and what is true of it.
struct KnownReturn {
  double range = 0;
  Eigen::Vector3d ray_map;   ///< unit vector along the beam
  Eigen::Vector3d from_map;  ///< where the LiDAR was
  TrueReturn truth;
};

/// All returns of all scans of a drive.
inline std::vector<KnownReturn> known_returns(Simulation& simulation) {
  std::vector<KnownReturn> out;
  for (const Scan& scan : record(simulation).scans) {
    const auto truth = simulation.true_geometry(scan);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const SE3 T_map_lidar = simulation.truth_at(scan.stamp + scan.points[i].time_offset_ns) *
                              simulation.options().lidar.T_body_lidar;
      const Eigen::Vector3d p = position(scan.points[i]);
      out.push_back(
          {p.norm(), T_map_lidar.rotation * p.normalized(), T_map_lidar.translation, truth[i]});
    }
  }
  return out;
}

/// Range from a place in the room to its walls.
inline double room_range(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d size(12, 8, 4);
  double range = 1e9;
  for (int k = 0; k < 3; ++k) {
    if (ray[k] > 0) range = std::min(range, (size[k] - from[k]) / ray[k]);
    if (ray[k] < 0) range = std::min(range, -from[k] / ray[k]);
  }
  return range;
}

}  // namespace holdfast::simulation::testing
