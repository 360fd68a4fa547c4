#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/map/fitting/point_grid.hpp"
#include "holdfast/map/tile_format.hpp"

namespace holdfast::map {

/// Surfaces of one level by cell; 0 or 1 + number of the cell's first surface. Covers the tile's
/// cells and one more on each side, from which empty cells borrow.
class SurfaceGrid {
 public:
  SurfaceGrid(double cell_m, int z_low, int z_high)
      : cell_m_(cell_m),
        side_(static_cast<int>(kTileSizeM / cell_m) + 2),
        z_low_(z_low - 1),
        height_(z_high - z_low + 3),
        first_(static_cast<std::size_t>(side_) * side_ * height_, 0) {}

  bool covers(const Cell& c) const {
    return c.x() >= -1 && c.y() >= -1 && c.x() < side_ - 1 && c.y() < side_ - 1 &&
           c.z() >= z_low_ && c.z() < z_low_ + height_;
  }
  std::uint32_t& first(const Cell& c) {
    return first_[(static_cast<std::size_t>(c.z() - z_low_) * side_ + c.y() + 1) * side_ + c.x() +
                  1];
  }
  double cell_m() const { return cell_m_; }

 private:
  double cell_m_;
  int side_;
  int z_low_;
  int height_;
  std::vector<std::uint32_t> first_;
};

}  // namespace holdfast::map
