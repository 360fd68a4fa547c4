#pragma once

#include <array>
#include <cstdint>

#include "holdfast/map/surface.hpp"

/// Layout of a tile file: TileHeader, then for each level the block index, the blocks and the
/// surfaces, each at the offset that the header gives. All values little endian.
///
/// A level is a grid of cells. 8 x 8 x 8 cells make a block; the block index covers the tile's
/// square and its range of z densely and holds 0 (nothing there) or 1 + the number of a block; a
/// block holds for each cell 0 (nothing near) or 1 + the number of its first surface. So a look-up
/// is three loads, and neighbouring points share them.
namespace holdfast::map {

constexpr std::uint32_t kTileMagic = 0x4c544648;  // "HFTL"
constexpr std::uint32_t kTileVersion = 2;
constexpr int kLevels = 3;
constexpr int kBlockCells = 8;  ///< cells along the side of a block
constexpr int kCellsPerBlock = kBlockCells * kBlockCells * kBlockCells;
constexpr double kTileSizeM = 32.0;

struct LevelHeader {
  float cell_m;            ///< side of a cell; a power of two, so that 32 m is a whole number
  std::int32_t blocks_xy;  ///< blocks along each horizontal side of the tile
  std::int32_t blocks_z;
  std::int32_t z_block;  ///< number of the lowest block: its floor is z_block * 8 * cell_m
  std::uint32_t block_count;
  std::uint32_t surface_count;
  std::uint64_t index_offset;     ///< std::uint32_t[blocks_z][blocks_xy][blocks_xy]
  std::uint64_t blocks_offset;    ///< std::uint32_t[block_count][512]
  std::uint64_t surfaces_offset;  ///< Surface[surface_count]
};

struct TileHeader {
  std::uint32_t magic;
  std::uint32_t version;
  std::int32_t ix,
      iy;  ///< the tile covers [ix, ix+1) x [iy, iy+1) times 32 m, from the map's origin
  std::uint64_t file_size;
  std::array<LevelHeader, kLevels> levels;
};

}  // namespace holdfast::map
