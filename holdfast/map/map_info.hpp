#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/map/tile_format.hpp"

namespace holdfast::map {

constexpr int kMapFormatVersion = 2;
constexpr std::string_view kMapFileName = "map.yaml";

struct TileInfo {
  std::int32_t ix = 0, iy = 0;
  std::uint64_t bytes = 0;
  std::uint64_t points = 0;
  std::uint64_t surface_checksum = 0;  ///< XXH3-64 of the .tile file
  std::uint64_t point_checksum = 0;    ///< XXH3-64 of the .points file

  std::string stem() const;  ///< "tiles/+003_-012"
};

/// A file of the map that is not a tile's.
struct FileInfo {
  std::uint64_t bytes = 0;
  std::uint64_t checksum = 0;  ///< XXH3-64
};

struct LevelInfo {
  double cell_m = 0;
  std::uint64_t planes = 0;
  std::uint64_t lines = 0;
};

/// What map.yaml says. Bounds are in the map frame; `origin` is the map-frame position that the
/// tiles count from (a multiple of the tile size in x and y).
struct MapInfo {
  std::string identity;  ///< hash of all tiles: two maps with one identity are the same map
  std::string source;    ///< file name of the cloud or log that the map was made from
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d bounds_min = Eigen::Vector3d::Zero();
  Eigen::Vector3d bounds_max = Eigen::Vector3d::Zero();
  Eigen::Vector3d gravity_map = {0, 0, -9.81};  ///< m/s^2 in the map frame
  std::uint64_t points = 0;
  double spacing_m = 0;  ///< typical distance between neighbouring points on a surface
  double noise_m = 0;    ///< typical RMS distance of points to their plane
  std::array<LevelInfo, kLevels> levels;
  std::optional<FileInfo> places;  ///< places.bin: what is usual where; none: made without
  std::vector<TileInfo> tiles;     ///< by iy, then ix
};

/// Reads DIR/map.yaml. Errors name file and key; a newer format says which version is read here.
Result<MapInfo> read_map_info(const std::filesystem::path& dir);
/// map.yaml as text: same map, same bytes.
std::string format_map_info(const MapInfo& info);
/// Identity from the checksums of all tiles.
std::string identity_of(const std::vector<TileInfo>& tiles);

}  // namespace holdfast::map
