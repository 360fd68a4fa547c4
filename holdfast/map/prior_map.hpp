#pragma once

#include <Eigen/Core>
#include <cmath>
#include <filesystem>
#include <memory>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/io/point_cloud.hpp"
#include "holdfast/map/map_info.hpp"
#include "holdfast/map/tile.hpp"

namespace holdfast::map {

/// The prior map: read-only, with the tiles near the robot mapped into memory.
///
/// Queries work in float around an *anchor*, the corner of the tile that holds the robot, so that
/// millimetres survive in a map of any size.
class PriorMap {
 public:
  /// Reads map.yaml; tiles are loaded by focus(). Errors name the file and what was expected.
  static Result<PriorMap> open(const std::filesystem::path& dir);

  const MapInfo& info() const { return info_; }
  /// The folder that the map was opened from.
  const std::filesystem::path& dir() const { return dir_; }

  /// Makes the tiles within `radius_m` of `p_map` available, drops those beyond twice that radius,
  /// and moves the anchor. Reads from disk only when the robot comes near new tiles.
  Status focus(const Eigen::Vector3d& p_map, double radius_m);

  /// Map-frame position of the anchor.
  const Eigen::Vector3d& anchor() const { return anchor_; }

  /// A surface and the place (relative to the anchor) that its centre counts from.
  struct Hit {
    const Surface* surface = nullptr;
    Eigen::Vector3f corner = Eigen::Vector3f::Zero();
  };

  /// First surface of the cell that holds `p` (relative to the anchor, metres); more of the same
  /// cell follow while Surface::more is set. Costs three loads.
  Hit find(int level, const Eigen::Vector3f& p) const {
    constexpr float kTilesPerM = 1.0F / static_cast<float>(kTileSizeM);
    const int dx = static_cast<int>(std::floor(p.x() * kTilesPerM));
    const int dy = static_cast<int>(std::floor(p.y() * kTilesPerM));
    const int x = anchor_ix_ + dx - low_ix_;
    const int y = anchor_iy_ + dy - low_iy_;
    if ((x < 0) | (y < 0) | (x >= width_) | (y >= height_)) return {};
    const Tile* tile = slots_[static_cast<std::size_t>(y) * width_ + x];
    if (tile == nullptr) return {};
    const Eigen::Vector3f corner(static_cast<float>(dx) * static_cast<float>(kTileSizeM),
                                 static_cast<float>(dy) * static_cast<float>(kTileSizeM), 0);
    return {tile->find(level, p - corner), corner};
  }

  std::size_t loaded_tiles() const { return tiles_.size(); }

  /// All points of the map in the map frame, tile by tile. Errors name a tile that does not hold
  /// what its checksum says.
  static Result<io::PointCloud> read_points(const std::filesystem::path& dir, const MapInfo& info);
  /// The points of one tile, relative to the map's origin.
  static Result<std::vector<Eigen::Vector3f>> read_tile_points(const std::filesystem::path& dir,
                                                               const TileInfo& tile);
  /// Reads every file of the map and compares its checksum.
  static Status verify(const std::filesystem::path& dir, const MapInfo& info);

 private:
  struct Loaded {
    std::size_t number;  ///< in info().tiles
    std::unique_ptr<Tile> tile;
  };

  PriorMap() = default;
  double distance_to(const TileInfo& tile, const Eigen::Vector3d& p_map) const;
  Status load(std::size_t number);

  std::filesystem::path dir_;
  MapInfo info_;
  std::vector<Loaded> tiles_;
  std::vector<const Tile*>
      slots_;  ///< dense grid over the map's tiles; nullptr: none or not loaded
  int low_ix_ = 0, low_iy_ = 0, width_ = 0, height_ = 0;
  int anchor_ix_ = 0, anchor_iy_ = 0;
  Eigen::Vector3d anchor_ = Eigen::Vector3d::Zero();
  bool focused_ = false;
};

}  // namespace holdfast::map
