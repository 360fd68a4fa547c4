#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "holdfast/core/random.hpp"
#include "simulation/sensors/lidar/returns/air.hpp"
#include "simulation/sensors/lidar/returns/footprint.hpp"
#include "simulation/sensors/lidar/returns/link_budget.hpp"
#include "simulation/sensors/lidar/returns/mirrors.hpp"

namespace holdfast::simulation {

/// Makes a stream of random numbers that belongs to a chunk of a scan and a purpose.
using StreamMaker = std::function<RandomStream(const char* purpose)>;

/// What comes back of the beams of a LiDAR with faults, or through weather. Each fault has a stream
/// of random numbers of its own, so that one does not change what another does. Weather weakens
/// echoes, which only the link budget feels: it limits the reach even of a LiDAR without that
/// fault.
class ReturnModel {
 public:
  /// None where nothing but LidarModel::range_sigma_m and materials spoil the returns.
  static std::optional<ReturnModel> create(const LidarModel& lidar, const Weather& weather);

  /// Turns what the axes of the beams met into what they return; those that return nothing get an
  /// infinite range. Ranges are without noise: range_sigma() says how much they have.
  void spoil(Beams& beams, const RayCaster& caster, const Materials& materials,
             const StreamMaker& stream) const;

  /// What an echo's intensity shows, 0 to 1: reflectivity * cos(theta), of a ghost as its mirror
  /// leaves it. Rain and dust are faint.
  static double brightness(const Echo& echo, const Materials& materials);

 private:
  ReturnModel(const LidarModel& lidar, const Weather& weather);
  std::vector<char> returned_by_material(const Beams& beams, const Materials& materials,
                                         RandomStream random) const;
  void lose_weak(Beams& beams, const Materials& materials, RandomStream random) const;
  void lose_some(Beams& beams, RandomStream random) const;
  void meet_air(Beams& beams, const std::vector<float>& free_m, RandomStream random) const;

  LidarModel lidar_;
  Air air_;
  LinkBudget budget_;
  Footprint footprint_;
  Mirrors mirrors_;
};

}  // namespace holdfast::simulation
