#include "holdfast/places/rendering/voxel_tile.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::places {

/// Where a point lies. Ordered by block, then voxel, then number of the point.
struct VoxelTile::Key {
  std::int32_t bz;
  std::uint32_t rest;  // by, bx, and z, y, x inside of the block
  std::uint32_t point;

  auto operator<=>(const Key&) const = default;
  int bx() const { return static_cast<int>(rest >> 9) % kBlocksPerTile; }
  int by() const { return static_cast<int>(rest >> 9) / kBlocksPerTile; }
  std::uint32_t voxel() const { return rest & 511U; }
  bool same_block(const Key& other) const { return bz == other.bz && rest >> 9 == other.rest >> 9; }
};

VoxelTile::Key VoxelTile::key_of(const Eigen::Vector3f& p, std::uint32_t number) {
  constexpr int kMost = kBlocksPerTile * kVoxelsPerBlock - 1;
  const int x = std::clamp(static_cast<int>(std::floor(p.x() / kVoxelM)), 0, kMost);
  const int y = std::clamp(static_cast<int>(std::floor(p.y() / kVoxelM)), 0, kMost);
  const int z = static_cast<int>(std::floor(p.z() / kVoxelM));
  const int column = (y >> 3) * kBlocksPerTile + (x >> 3);
  const int voxel = ((z & 7) * kVoxelsPerBlock + (y & 7)) * kVoxelsPerBlock + (x & 7);
  return {z >> 3, static_cast<std::uint32_t>(column << 9 | voxel), number};
}

void VoxelTile::add_voxel(const Key& key) {
  Block& block = blocks_.back();
  const std::uint32_t layer = key.voxel() >> 6;
  block.bits_[layer] |= std::uint64_t{1} << (key.voxel() & 63U);
  // Voxels come in order: all later layers begin behind this one.
  for (std::uint32_t z = layer + 1; z < kVoxelsPerBlock; ++z) {
    block.first_[z] = static_cast<std::uint32_t>(begin_.size()) + 1;
  }
  begin_.push_back(static_cast<std::uint32_t>(points_.size()));
}

VoxelTile::VoxelTile(const std::vector<Eigen::Vector3f>& points) {
  if (points.empty()) return;
  std::vector<Key> keys;
  keys.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) keys.push_back(key_of(points[i], i));
  std::sort(keys.begin(), keys.end());
  low_z_ = keys.front().bz;
  layers_ = keys.back().bz - low_z_ + 1;
  index_.assign(static_cast<std::size_t>(layers_) * kBlocksPerTile * kBlocksPerTile, 0);
  points_.reserve(points.size());
  const Key* last = nullptr;
  for (const Key& key : keys) {
    if (last == nullptr || !key.same_block(*last)) {
      blocks_.emplace_back().first_.fill(static_cast<std::uint32_t>(begin_.size()));
      index_[((key.bz - low_z_) * kBlocksPerTile + key.by()) * kBlocksPerTile + key.bx()] =
          static_cast<std::uint32_t>(blocks_.size());
      add_voxel(key);
    } else if (key.voxel() != last->voxel()) {
      add_voxel(key);
    }
    points_.push_back(points[key.point]);
    last = &key;
  }
  begin_.push_back(static_cast<std::uint32_t>(points_.size()));
}

}  // namespace holdfast::places
