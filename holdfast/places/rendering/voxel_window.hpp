#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "holdfast/core/parallel.hpp"
#include "holdfast/core/result.hpp"
#include "holdfast/map/prior_map.hpp"
#include "holdfast/places/rendering/voxel_tile.hpp"

namespace holdfast::places {

/// A ray from `from` along the unit vector `direction`.
struct Ray {
  Eigen::Vector3f from;
  Eigen::Vector3f direction;
};

/// The points of a map around a few of its tiles. Positions are relative to the corner of the tile
/// `ix`, `iy` that a query names (z: to the map's origin), as those of a PriorMap that is focused
/// there. Queries are thread-safe between two calls of load_rows().
class VoxelWindow {
 public:
  VoxelWindow(std::filesystem::path dir, const map::MapInfo& info)
      : dir_(std::move(dir)), info_(info) {}

  /// Makes the rows of tiles around row `iy` available that lie within `reach_m` of it, and drops
  /// the others: not more than 2 ceil(reach_m / 32) + 1 rows are in memory.
  Status load_rows(std::int32_t iy, float reach_m, WorkerPool& pool);

  /// The first point of the map that the ray meets within `reach_m`: the point nearest to the ray
  /// of the first voxel in which one is nearer to it than `touch_m`, or in which the ray crosses a
  /// closed plane of `map` (focused on that tile): between the points of a wall nothing is seen.
  std::optional<Eigen::Vector3f> first_hit(std::int32_t ix, std::int32_t iy,
                                           const map::PriorMap& map, const Ray& ray, float reach_m,
                                           float touch_m) const;

  /// True if no point lies in the upright cylinder (by voxels, by their centres and low borders).
  bool is_free(std::int32_t ix, std::int32_t iy, const Eigen::Vector3f& base, float radius_m,
               float height_m) const;

 private:
  using Key = std::pair<std::int32_t, std::int32_t>;  // iy, ix
  const VoxelTile* tile(std::int32_t ix, std::int32_t iy) const;
  bool is_occupied(std::int32_t ix, std::int32_t iy, int x, int y, int z) const;

  std::filesystem::path dir_;
  const map::MapInfo& info_;
  std::map<Key, std::unique_ptr<VoxelTile>> tiles_;
};

}  // namespace holdfast::places
