#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace holdfast::simulation {

/// Square cells over a rectangle of the ground; a cell is known by one number.
struct Grid {
  Eigen::Vector2d low{0, 0};  ///< corner of the first cell
  double cell_m = 0.25;
  std::int32_t width = 0;  ///< cells along x
  std::int32_t height = 0;

  std::size_t size() const { return static_cast<std::size_t>(width) * height; }
  bool contains(std::int32_t x, std::int32_t y) const {
    return x >= 0 && y >= 0 && x < width && y < height;
  }
  std::size_t index(std::int32_t x, std::int32_t y) const {
    return static_cast<std::size_t>(y) * width + x;
  }
  std::int32_t column(std::size_t i) const { return static_cast<std::int32_t>(i % width); }
  std::int32_t row(std::size_t i) const { return static_cast<std::int32_t>(i / width); }
  Eigen::Vector2d center(std::size_t i) const {
    return low + cell_m * Eigen::Vector2d(column(i) + 0.5, row(i) + 0.5);
  }
  /// The cell that holds a place; size() outside.
  std::size_t at(const Eigen::Vector2d& p) const {
    const Eigen::Array2d cell = ((p - low) / cell_m).array().floor();
    if (!(cell[0] >= 0 && cell[1] >= 0 && cell[0] < width && cell[1] < height)) return size();
    return index(static_cast<std::int32_t>(cell[0]), static_cast<std::int32_t>(cell[1]));
  }
  /// visit(neighbour, cells to it) for the up to eight cells around a cell.
  template <class Visit>
  void around(std::size_t i, const Visit& visit) const {
    for (std::int32_t dy = -1; dy <= 1; ++dy) {
      for (std::int32_t dx = -1; dx <= 1; ++dx) {
        const std::int32_t x = column(i) + dx;
        const std::int32_t y = row(i) + dy;
        if ((dx == 0 && dy == 0) || !contains(x, y)) continue;
        visit(index(x, y), dx != 0 && dy != 0 ? std::sqrt(2.0) : 1.0);
      }
    }
  }
};

/// Metres from each cell to the nearest of the `sources`, over straight and diagonal steps (up to 8
/// % too long); infinite without a source.
std::vector<float> distances_to(const Grid& grid, const std::vector<bool>& sources);

}  // namespace holdfast::simulation
