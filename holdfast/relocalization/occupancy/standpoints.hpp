#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "holdfast/places/places.hpp"
#include "holdfast/relocalization/occupancy/occupancy_pyramid.hpp"

namespace holdfast::relocalization {

/// Cells in which the LiDAR of a lost robot may be, as columns of bits: those near a place to which
/// a level way leads from there, up to the first obstacle. Level L has one column for each block of
/// 2^L x 2^L cells: the union. Read-only, thread-safe.
class Standpoints {
 public:
  struct Reach {
    float aside_m = 6.0F;  ///< of a place: floors that shine have few of them
    float lowest_m = -0.8F, highest_m = 1.2F;
  };

  /// Positions count from the map's origin.
  Standpoints(const std::vector<places::Place>& places, const OccupancyPyramid& map,
              const Reach& reach);

  /// A column of a level: block x, y (of 2^level cells each) and one word of its heights.
  struct Block {
    int x = 0, y = 0, word = 0;
    std::uint64_t lanes = 0;
  };
  /// All blocks of the coarsest level in which a LiDAR may be.
  const std::vector<Block>& roots() const { return roots_; }
  /// Lane 0 of a word as a cell.
  int low_z(int word) const { return low_.z + kLanes * word; }
  int words() const { return words_; }

  std::uint64_t lanes(int level, int x, int y, int word) const {
    const Level& l = levels_[level];
    const int column = x - (low_.x >> level), row = y - (low_.y >> level);
    if (column < 0 || row < 0 || column >= l.width || row >= l.height) return 0;
    return l.columns[(static_cast<std::size_t>(row) * l.width + column) * words_ + word];
  }

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<std::uint64_t> columns;
  };

  void spread(const places::Place& place, const OccupancyPyramid& map, const Reach& reach);
  void mark(int x, int y, float z, const Reach& reach);
  void make_coarser(int level);

  Cell low_;
  int words_ = 1;
  std::vector<Level> levels_;
  std::vector<Block> roots_;
};

}  // namespace holdfast::relocalization
