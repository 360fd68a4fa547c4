#pragma once

#include <vector>

#include "holdfast/core/random.hpp"
#include "simulation/sensors/lidar/lidar_model.hpp"
#include "simulation/sensors/lidar/returns/beams.hpp"
#include "simulation/world/ray_caster.hpp"

namespace holdfast::simulation {

/// Beams that go on from the first surface they meet. What moves is not seen in mirrors.
///
/// Ghosts: of the beams that a surface with a mirror share does not return itself, the share
/// ghost_share * mirror_return is mirrored. The surface that such a beam meets then is returned, if
/// its material returns it, at the summed range along the beam: it seems to stand behind the
/// mirror. Its light was mirrored twice: power mirror_return^2.
///
/// Multipath: of the beams returned by a surface without a mirror share, multipath_share is thrown
/// on; where a second face stands within kCorner of the first, the pulse that comes back by way of
/// both is returned, at half of the way round: (r_1 + d_12 + r_2) / 2.
class Mirrors {
 public:
  static constexpr float kCorner = 1;  ///< metres

  explicit Mirrors(const LidarModel& lidar);

  /// `returned` says of each beam whether the first surface returns it; it is updated. Draws two
  /// random numbers a beam.
  void throw_on(Beams& beams, std::vector<char>& returned, const RayCaster& caster,
                const Materials& materials, RandomStream& random) const;

 private:
  struct Thrown;
  std::vector<Thrown> thrown(const Beams& beams, const std::vector<char>& returned,
                             const Materials& materials, RandomStream& random) const;
  static RayPacket packet_of(const Beams& beams, const std::vector<Thrown>& thrown,
                             std::size_t first, const RayCaster& caster);

  LidarFaults faults_;
  float max_range_m_;
};

}  // namespace holdfast::simulation
