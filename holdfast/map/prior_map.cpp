#include "holdfast/map/prior_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "holdfast/map/checksum.hpp"
#include "holdfast/map/map_files.hpp"

namespace holdfast::map {
namespace {

Result<std::vector<std::byte>> read_point_file(const std::filesystem::path& dir,
                                               const TileInfo& tile) {
  return read_checked(dir / (tile.stem() + ".points"), tile.points * sizeof(Eigen::Vector3f),
                      tile.point_checksum);
}

}  // namespace

Result<PriorMap> PriorMap::open(const std::filesystem::path& dir) {
  auto info = read_map_info(dir);
  if (!info) return info.error();
  PriorMap map;
  map.dir_ = dir;
  map.info_ = std::move(*info);
  int high_ix = std::numeric_limits<int>::min();
  int high_iy = std::numeric_limits<int>::min();
  map.low_ix_ = map.low_iy_ = std::numeric_limits<int>::max();
  for (const TileInfo& tile : map.info_.tiles) {
    map.low_ix_ = std::min(map.low_ix_, tile.ix);
    map.low_iy_ = std::min(map.low_iy_, tile.iy);
    high_ix = std::max(high_ix, tile.ix);
    high_iy = std::max(high_iy, tile.iy);
  }
  if (map.info_.tiles.empty()) return Error{fmt::format("{}: a map without tiles", dir.string())};
  // In 64 bits: a damaged map.yaml may hold any number.
  const std::int64_t width = std::int64_t{high_ix} - map.low_ix_ + 1;
  const std::int64_t height = std::int64_t{high_iy} - map.low_iy_ + 1;
  constexpr std::int64_t kMostSlots = 16'000'000;
  if (width > kMostSlots || height > kMostSlots || width * height > kMostSlots) {
    return Error{
        fmt::format("{}: its tiles span {} x {} tiles, at most {} expected: is {} damaged?",
                    dir.string(), width, height, kMostSlots, kMapFileName)};
  }
  map.width_ = static_cast<int>(width);
  map.height_ = static_cast<int>(height);
  map.slots_.assign(static_cast<std::size_t>(map.width_) * map.height_, nullptr);
  return map;
}

double PriorMap::distance_to(const TileInfo& tile, const Eigen::Vector3d& p_map) const {
  const Eigen::Vector2d corner =
      info_.origin.head<2>() + kTileSizeM * Eigen::Vector2d(tile.ix, tile.iy);
  const Eigen::Vector2d d = p_map.head<2>() - corner;
  const Eigen::Vector2d outside =
      (-d).cwiseMax(d - Eigen::Vector2d::Constant(kTileSizeM)).cwiseMax(0.0);
  return outside.norm();
}

Status PriorMap::load(std::size_t number) {
  const TileInfo& info = info_.tiles[number];
  const auto path = dir_ / (info.stem() + ".tile");
  auto tile = Tile::open(path);
  if (!tile) return tile.error();
  if (tile->size_bytes() != info.bytes ||
      checksum(&tile->header(), tile->size_bytes()) != info.surface_checksum) {
    return Error{
        fmt::format("{}: content does not match its checksum in map.yaml: import the map "
                    "again",
                    path.string())};
  }
  tiles_.push_back({number, std::make_unique<Tile>(std::move(*tile))});
  slots_[static_cast<std::size_t>(info.iy - low_iy_) * width_ + info.ix - low_ix_] =
      tiles_.back().tile.get();
  return Done{};
}

Status PriorMap::focus(const Eigen::Vector3d& p_map, double radius_m) {
  const Eigen::Vector3d local = p_map - info_.origin;
  const int ix = static_cast<int>(std::floor(local.x() / kTileSizeM));
  const int iy = static_cast<int>(std::floor(local.y() / kTileSizeM));
  if (focused_ && ix == anchor_ix_ && iy == anchor_iy_) return Done{};
  focused_ = false;  // until all tiles are there
  anchor_ix_ = ix;
  anchor_iy_ = iy;
  anchor_ = info_.origin + Eigen::Vector3d(ix * kTileSizeM, iy * kTileSizeM, 0);
  std::erase_if(tiles_, [&](const Loaded& loaded) {
    const TileInfo& info = info_.tiles[loaded.number];
    if (distance_to(info, p_map) <= 2.0 * radius_m + kTileSizeM) return false;
    slots_[static_cast<std::size_t>(info.iy - low_iy_) * width_ + info.ix - low_ix_] = nullptr;
    return true;
  });
  for (std::size_t i = 0; i < info_.tiles.size(); ++i) {
    const TileInfo& info = info_.tiles[i];
    // One tile more than the radius: the anchor moves only when the robot crosses a border.
    if (distance_to(info, p_map) > radius_m + kTileSizeM) continue;
    if (slots_[static_cast<std::size_t>(info.iy - low_iy_) * width_ + info.ix - low_ix_]) continue;
    if (auto loaded = load(i); !loaded) return loaded;
  }
  focused_ = true;
  return Done{};
}

Result<io::PointCloud> PriorMap::read_points(const std::filesystem::path& dir,
                                             const MapInfo& info) {
  io::PointCloud cloud;
  cloud.origin = info.origin;
  cloud.points.reserve(info.points);
  for (const TileInfo& tile : info.tiles) {
    auto points = read_tile_points(dir, tile);
    if (!points) return points.error();
    cloud.points.insert(cloud.points.end(), points->begin(), points->end());
  }
  return cloud;
}

Result<std::vector<Eigen::Vector3f>> PriorMap::read_tile_points(const std::filesystem::path& dir,
                                                                const TileInfo& tile) {
  auto content = read_point_file(dir, tile);
  if (!content) return content.error();
  std::vector<Eigen::Vector3f> points(tile.points);
  if (!points.empty()) std::memcpy(points.data()->data(), content->data(), content->size());
  return points;
}

Status PriorMap::verify(const std::filesystem::path& dir, const MapInfo& info) {
  for (const TileInfo& tile : info.tiles) {
    auto surfaces = read_checked(dir / (tile.stem() + ".tile"), tile.bytes, tile.surface_checksum);
    if (!surfaces) return surfaces.error();
    if (auto points = read_point_file(dir, tile); !points) return points.error();
  }
  if (!info.places) return Done{};
  auto places = read_checked(dir / kPlacesFileName, info.places->bytes, info.places->checksum);
  if (!places) return places.error();
  return Done{};
}

}  // namespace holdfast::map
