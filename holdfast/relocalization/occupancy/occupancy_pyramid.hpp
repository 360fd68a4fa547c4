#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/map/map_info.hpp"

namespace holdfast::relocalization {

/// A cell of the grid: kCellM of the map's origin each.
struct Cell {
  int x = 0, y = 0, z = 0;
  bool operator==(const Cell&) const = default;
};

inline constexpr float kCellM = 0.5F;
inline constexpr int kLanes = 64;  ///< heights that one word tells about

/// Where a map has points: columns of cells as bits over their height, and coarser levels in which
/// a column is the union of all columns of a block. Level L answers for any block of 2^L x 2^L
/// columns, wherever it begins; from level 3 on for a margin of a quarter of it more, so that all
/// levels together take 3.4 times the memory of the finest. Read-only, thread-safe.
class OccupancyPyramid {
 public:
  static constexpr int kLevels = 4;

  /// `points` count from the map's origin. A cell is occupied by a point in it, or less than
  /// `grown_m` beside it. `margin_m` is known to be empty around.
  OccupancyPyramid(std::span<const Eigen::Vector3f> points, float grown_m, float margin_m);
  /// Of all tiles of a map.
  static Result<OccupancyPyramid> of_map(const std::filesystem::path& dir, const map::MapInfo& info,
                                         float grown_m, float margin_m);

  /// Words of a column.
  int words() const { return words_; }
  /// The lowest height of the grid.
  int low_z() const { return low_.z; }
  bool occupied(const Cell& cell) const;

  /// The union of the columns [x, x + 2^level) x [y, y + 2^level), from low_z() up. Not asked for
  /// farther out than the margin.
  const std::uint64_t* column(int level, int x, int y) const {
    const Level& l = levels_[level];
    const auto row = static_cast<std::size_t>((y - low_.y) >> l.shift);
    return l.columns.data() +
           (row * l.width + static_cast<std::size_t>((x - low_.x) >> l.shift)) * words_;
  }
  /// Levels below this have their columns in the same order, row_step() words from row to row.
  static constexpr int kFirstStrided = 3;
  std::ptrdiff_t row_step() const { return static_cast<std::ptrdiff_t>(levels_[0].width) * words_; }
  bool reaches(int x, int y) const {
    return x >= low_.x && y >= low_.y && x < low_.x + width_ && y < low_.y + height_;
  }
  /// Words in all.
  std::size_t size() const;

 private:
  struct Level {
    int shift = 0;  ///< a column for each 2^shift
    std::size_t width = 0, height = 0;
    std::vector<std::uint64_t> columns;
  };

  void make_coarser(int level);

  Cell low_;
  int width_ = 0, height_ = 0, words_ = 1;
  std::vector<Level> levels_;
};

}  // namespace holdfast::relocalization
