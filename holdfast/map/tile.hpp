#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <utility>

#include "holdfast/core/result.hpp"
#include "holdfast/map/tile_format.hpp"

namespace holdfast::map {

/// One tile of the prior map, mapped into memory and read-only.
class Tile {
 public:
  /// Maps the file and checks that header and sizes hold together (not the checksum: see
  /// verify_checksum). Errors name the file and what was expected.
  static Result<Tile> open(const std::filesystem::path& path);
  Tile(Tile&& other) noexcept;
  Tile& operator=(Tile&& other) noexcept;
  ~Tile();

  const TileHeader& header() const { return *reinterpret_cast<const TileHeader*>(data_); }
  std::size_t size_bytes() const { return size_; }

  /// First surface of the cell that holds `p` (relative to the tile's corner; metres), or nullptr.
  const Surface* find(int level, const Eigen::Vector3f& p) const {
    const Level& l = levels_[level];
    const int cx = static_cast<int>(p.x() * l.cells_per_m);
    const int cy = static_cast<int>(p.y() * l.cells_per_m);
    const int cz = static_cast<int>(p.z() * l.cells_per_m + l.z_shift);
    const int bx = cx >> 3;
    const int by = cy >> 3;
    const int bz = cz >> 3;
    if ((bx < 0) | (by < 0) | (cz < 0) | (bx >= l.blocks_xy) | (by >= l.blocks_xy) |
        (bz >= l.blocks_z)) {
      return nullptr;
    }
    const std::uint32_t block = l.index[(bz * l.blocks_xy + by) * l.blocks_xy + bx];
    if (block == 0) return nullptr;
    const std::uint32_t cell = ((cz & 7) * kBlockCells + (cy & 7)) * kBlockCells + (cx & 7);
    const std::uint32_t surface = l.blocks[(block - 1) * kCellsPerBlock + cell];
    return surface == 0 ? nullptr : l.surfaces + (surface - 1);
  }

  const Surface* surfaces(int level) const { return levels_[level].surfaces; }

 private:
  struct Level {
    float cells_per_m = 0;
    float z_shift = 0;
    int blocks_xy = 0;
    int blocks_z = 0;
    const std::uint32_t* index = nullptr;
    const std::uint32_t* blocks = nullptr;
    const Surface* surfaces = nullptr;
  };

  Tile(const std::byte* data, std::size_t size) : data_(data), size_(size) {}
  Status bind(const std::filesystem::path& path);

  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  std::array<Level, kLevels> levels_{};
};

}  // namespace holdfast::map
