#include "holdfast/places/rendering/voxel_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace holdfast::places {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

constexpr float kPast = 1e-4F;  // m past the border of a cell: well inside of the next

int floor_div(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

/// A ray ready to be followed from cell to cell.
struct Path {
  explicit Path(const Ray& ray)
      : from(ray.from), direction(ray.direction), inverse(ray.direction.cwiseInverse()) {}

  Vector3f at(float t) const { return from + t * direction; }
  Vector3i cell(float t, float cell_m) const {
    return (at(t) / cell_m).array().floor().cast<int>();
  }
  /// Where the ray leaves a cell.
  float exit(const Vector3i& cell, float cell_m) const {
    float least = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0) continue;
      const float border = cell_m * static_cast<float>(cell[axis] + (direction[axis] > 0 ? 1 : 0));
      least = std::min(least, (border - from[axis]) * inverse[axis]);
    }
    return least;
  }

  Vector3f from, direction, inverse;
};

/// A block, its tile, and where that stands.
struct Site {
  const VoxelTile* tile = nullptr;
  const VoxelTile::Block* block = nullptr;
  Vector3f corner = Vector3f::Zero();  // of the tile
  Vector3i low = Vector3i::Zero();     // first voxel of the block
};

/// The point of a voxel that is nearest to the ray, if one is near enough.
std::optional<Vector3f> nearest_point(const Site& site, const Vector3i& voxel, const Path& path,
                                      float touch_m) {
  std::optional<Vector3f> nearest;
  float least = touch_m * touch_m;
  for (const Vector3f& p : site.tile->points(*site.block, voxel.x(), voxel.y(), voxel.z())) {
    const Vector3f way = p + site.corner - path.from;
    const float off = way.cross(path.direction).squaredNorm();
    if (off >= least) continue;
    least = off;
    nearest = p + site.corner;
  }
  return nearest;
}

/// Does the ray cross a closed plane between `begin` and `end` metres from its start?
bool crosses_wall(const map::PriorMap& map, const Path& path, float begin, float end) {
  constexpr float kNoiseM = 0.03F;  // of the points: they may lie in the next voxel
  const auto found = map.find(0, path.at(0.5F * (begin + end)));
  for (const map::Surface* s = found.surface; s != nullptr; s = s->more != 0 ? s + 1 : nullptr) {
    if (s->closed == 0) continue;
    const float t =
        s->normal.dot(s->center + found.corner - path.from) / s->normal.dot(path.direction);
    if (t > begin - kNoiseM && t < end + kNoiseM) return true;
  }
  return false;
}

/// How near a ray must come to a point, and the planes between the points.
struct Touch {
  float touch_m;
  const map::PriorMap& map;
};

/// The first hit between `t` and `end` inside of one block.
std::optional<Vector3f> hit_in_block(const Site& site, const Path& path, float t, float end,
                                     const Touch& touch) {
  constexpr float kAnywhere = 2.0F * kVoxelM;
  while (t < end) {
    const Vector3i voxel = path.cell(t, kVoxelM);
    const Vector3i inside = voxel - site.low;
    const float exit = std::max(t, path.exit(voxel, kVoxelM));
    if ((inside.array() >= 0).all() && (inside.array() < kVoxelsPerBlock).all() &&
        site.block->occupied(inside.x(), inside.y(), inside.z())) {
      if (const auto hit = nearest_point(site, inside, path, touch.touch_m)) return hit;
      if (crosses_wall(touch.map, path, t, exit)) {
        return nearest_point(site, inside, path, kAnywhere);
      }
    }
    t = exit + kPast;
  }
  return std::nullopt;
}

}  // namespace

Status VoxelWindow::load_rows(std::int32_t iy, float reach_m, WorkerPool& pool) {
  const auto rows = static_cast<std::int32_t>(std::ceil(reach_m / map::kTileSizeM));
  std::erase_if(tiles_, [&](const auto& entry) { return std::abs(entry.first.first - iy) > rows; });
  std::vector<const map::TileInfo*> missing;
  for (const map::TileInfo& tile : info_.tiles) {
    if (std::abs(tile.iy - iy) <= rows && !tiles_.contains({tile.iy, tile.ix})) {
      missing.push_back(&tile);
    }
  }
  std::vector<std::unique_ptr<VoxelTile>> made(missing.size());
  std::vector<Status> status(missing.size(), Done{});
  pool.run(missing.size(), [&](std::size_t i) {
    auto points = map::PriorMap::read_tile_points(dir_, *missing[i]);
    if (!points) {
      status[i] = points.error();
      return;
    }
    const Eigen::Vector3d corner(missing[i]->ix * map::kTileSizeM, missing[i]->iy * map::kTileSizeM,
                                 0);
    for (Vector3f& p : *points) p = (p.cast<double>() - corner).cast<float>();
    made[i] = std::make_unique<VoxelTile>(*points);
  });
  for (std::size_t i = 0; i < missing.size(); ++i) {
    if (!status[i].ok()) return status[i];
    tiles_[{missing[i]->iy, missing[i]->ix}] = std::move(made[i]);
  }
  return Done{};
}

const VoxelTile* VoxelWindow::tile(std::int32_t ix, std::int32_t iy) const {
  const auto found = tiles_.find({iy, ix});
  return found == tiles_.end() ? nullptr : found->second.get();
}

std::optional<Vector3f> VoxelWindow::first_hit(std::int32_t ix, std::int32_t iy,
                                               const map::PriorMap& map, const Ray& ray,
                                               float reach_m, float touch_m) const {
  const Path path(ray);
  const Touch touch{touch_m, map};
  Site site;
  Vector3i tile_at(std::numeric_limits<int>::max(), 0, 0);
  for (float t = 0; t < reach_m;) {
    const Vector3i block = path.cell(t, kBlockM);
    const float end = path.exit(block, kBlockM);
    const Vector3i at(floor_div(block.x(), kBlocksPerTile), floor_div(block.y(), kBlocksPerTile),
                      0);
    if (at != tile_at) {
      tile_at = at;
      site.tile = tile(ix + at.x(), iy + at.y());
      site.corner = static_cast<float>(map::kTileSizeM) * at.cast<float>();
    }
    if (site.tile != nullptr) {
      site.block = site.tile->block(block.x() - at.x() * kBlocksPerTile,
                                    block.y() - at.y() * kBlocksPerTile, block.z());
      if (site.block != nullptr) {
        site.low = kVoxelsPerBlock * block;
        if (const auto hit = hit_in_block(site, path, t, std::min(end, reach_m), touch)) {
          return hit;
        }
      }
    }
    t = std::max(t, end) + kPast;
  }
  return std::nullopt;
}

bool VoxelWindow::is_occupied(std::int32_t ix, std::int32_t iy, int x, int y, int z) const {
  constexpr int kAcross = kBlocksPerTile * kVoxelsPerBlock;
  const int dx = floor_div(x, kAcross);
  const int dy = floor_div(y, kAcross);
  const VoxelTile* at = tile(ix + dx, iy + dy);
  if (at == nullptr) return false;
  const int lx = x - dx * kAcross;
  const int ly = y - dy * kAcross;
  const auto* block = at->block(lx >> 3, ly >> 3, z >> 3);
  return block != nullptr && block->occupied(lx & 7, ly & 7, z & 7);
}

bool VoxelWindow::is_free(std::int32_t ix, std::int32_t iy, const Vector3f& base, float radius_m,
                          float height_m) const {
  const auto low = [&](float v) { return static_cast<int>(std::floor((v - radius_m) / kVoxelM)); };
  const auto high = [&](float v) { return static_cast<int>(std::floor((v + radius_m) / kVoxelM)); };
  const int z_low = static_cast<int>(std::ceil(base.z() / kVoxelM));
  const int z_high = static_cast<int>(std::ceil((base.z() + height_m) / kVoxelM));
  for (int y = low(base.y()); y <= high(base.y()); ++y) {
    for (int x = low(base.x()); x <= high(base.x()); ++x) {
      const float dx = kVoxelM * (static_cast<float>(x) + 0.5F) - base.x();
      const float dy = kVoxelM * (static_cast<float>(y) + 0.5F) - base.y();
      if (dx * dx + dy * dy > radius_m * radius_m) continue;
      for (int z = z_low; z < z_high; ++z) {
        if (is_occupied(ix, iy, x, y, z)) return false;
      }
    }
  }
  return true;
}

}  // namespace holdfast::places
