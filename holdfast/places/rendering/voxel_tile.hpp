#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace holdfast::places {

constexpr int kVoxelsPerBlock = 8;  ///< along a side
constexpr int kBlocksPerTile = 20;  ///< along a horizontal side
/// Side of a voxel: 0.2 m, so that a tile of 32 m is a whole number of blocks.
constexpr float kVoxelM = 32.0F / (kBlocksPerTile * kVoxelsPerBlock);
constexpr float kBlockM = kVoxelM * kVoxelsPerBlock;

/// The points of one tile of a map by voxels, in blocks of 8 x 8 x 8 of them. Positions count from
/// the tile's corner (z: from the map's origin), and so do voxels and blocks.
class VoxelTile {
 public:
  /// `points` relative to the tile's corner; those outside of the tile are taken for its rim.
  explicit VoxelTile(const std::vector<Eigen::Vector3f>& points);

  class Block {
   public:
    bool occupied(int x, int y, int z) const { return (bits_[z] >> (8 * y + x) & 1U) != 0; }

   private:
    friend class VoxelTile;
    std::array<std::uint64_t, kVoxelsPerBlock> bits_{};   // one word a layer
    std::array<std::uint32_t, kVoxelsPerBlock> first_{};  // occupied voxels before each layer
  };

  /// nullptr where no point is.
  const Block* block(int bx, int by, int bz) const {
    const int z = bz - low_z_;
    if (z < 0 || z >= layers_) return nullptr;
    const std::uint32_t number = index_[(z * kBlocksPerTile + by) * kBlocksPerTile + bx];
    return number == 0 ? nullptr : &blocks_[number - 1];
  }

  /// Points of an occupied voxel of a block.
  std::span<const Eigen::Vector3f> points(const Block& block, int x, int y, int z) const {
    const std::uint64_t before = block.bits_[z] & ((std::uint64_t{1} << (8 * y + x)) - 1);
    const std::size_t voxel = block.first_[z] + static_cast<std::size_t>(std::popcount(before));
    return {points_.data() + begin_[voxel], points_.data() + begin_[voxel + 1]};
  }

 private:
  struct Key;
  static Key key_of(const Eigen::Vector3f& p, std::uint32_t number);
  void add_voxel(const Key& key);

  int low_z_ = 0;  // lowest layer of blocks
  int layers_ = 0;
  std::vector<std::uint32_t> index_;  // 0, or 1 + number of the block
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> begin_;  // first point of each occupied voxel, and the end
  std::vector<Eigen::Vector3f> points_;
};

}  // namespace holdfast::places
