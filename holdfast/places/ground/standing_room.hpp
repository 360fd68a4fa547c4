#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/map/map_info.hpp"
#include "holdfast/places/rendering/voxel_window.hpp"

namespace holdfast::places {

constexpr float kColumnM = 0.5F;  ///< side of the columns that the ground is looked at in

/// A piece of floor on which something could stand: a near-horizontal plane in one column.
struct Standing {
  std::int32_t cx = 0, cy = 0;  ///< column: [cx, cx + 1) x [cy, cy + 1) * kColumnM, from the origin
  float z_m = 0;                ///< of the floor, from the map's origin
  bool clear = false;           ///< free for a robot of 0.5 m radius; all are free for one of 0.3 m

  float x_m() const { return kColumnM * (static_cast<float>(cx) + 0.5F); }
  float y_m() const { return kColumnM * (static_cast<float>(cy) + 0.5F); }
};

/// All of a tile that is free from 0.3 to 1.6 m above a floor, by column (y, then x) and height.
/// `window` must hold the tile's row and its neighbours. What was never seen counts as free here.
Result<std::vector<Standing>> find_standing_room(const std::filesystem::path& dir,
                                                 const map::TileInfo& tile, double cell_m,
                                                 const VoxelWindow& window);

}  // namespace holdfast::places
