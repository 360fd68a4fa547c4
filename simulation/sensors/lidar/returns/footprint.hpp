#pragma once

#include "holdfast/core/random.hpp"
#include "simulation/sensors/lidar/lidar_model.hpp"
#include "simulation/sensors/lidar/returns/beams.hpp"
#include "simulation/sensors/lidar/returns/depth_edges.hpp"
#include "simulation/world/ray_caster.hpp"

namespace holdfast::simulation {

/// The extent of a beam: a disc of equal brightness. At depth edges eight rays are cast within it,
/// each of the power reflectivity cos(theta) / r^2 times speckle (exponentially distributed, of
/// mean 1). Surfaces less than a pulse's length apart, one to the next, return as one, at the mean
/// of their ranges weighted by power; of those further apart the strongest is kept, or the last.
/// Beams that meet one surface only are left as they are.
class Footprint {
 public:
  explicit Footprint(const LidarModel& lidar);

  /// Looks at the beams of a chunk, with two random numbers for each of the eight rays of a beam at
  /// an edge, and a third one for those that meet two surfaces.
  void look(Beams& beams, const RayCaster& caster, const Materials& materials,
            RandomStream& random) const;

 private:
  struct Ray;
  RayPacket rays_of(const Beams& beams, std::size_t i, RandomStream& random) const;
  Echo merged(std::vector<Ray>& rays) const;
  void look_into(Echo& echo, const Beams& beams, std::size_t i, const RayCaster& caster,
                 const Materials& materials, RandomStream& random) const;
  void blur_silhouette(Echo& echo, const Beams& beams, std::size_t i, const Materials& materials,
                       RandomStream& random) const;

  DepthEdges edges_;
  float radius_;  ///< of the disc, radians
  float pulse_length_m_;
  float min_range_m_, max_range_m_;
  bool keep_last_;
};

}  // namespace holdfast::simulation
