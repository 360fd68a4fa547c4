#pragma once

#include <cstdint>

#include "holdfast/core/parallel.hpp"
#include "holdfast/io/point_cloud.hpp"
#include "simulation/motion/route.hpp"
#include "simulation/world/ray_caster.hpp"

namespace holdfast::simulation {

/// How a world is surveyed.
struct SurveyModel {
  double spacing_m = 0.06;     ///< one point in each square of this size, somewhere near its middle
  double sigma_m = 0.005;      ///< noise on each axis
  double height_m = 0.6;       ///< of the LiDAR above the route
  double range_m = 100.0;      ///< how far the LiDAR sees
  double least_cosine = 0.03;  ///< surfaces seen more grazingly are left out
};

/// Points on the fronts of the world's triangles that can be seen from the route, less what the
/// materials keep from a surveyor, and the centres of its discs that can be seen from either side:
/// a cloud is known at its points only. Same seed, same cloud, for any number of threads.
io::PointCloud survey(const World& world, const RayCaster& caster, const Route& route,
                      const SurveyModel& model, std::uint64_t seed, WorkerPool& pool);

}  // namespace holdfast::simulation
