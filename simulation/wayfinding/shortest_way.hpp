#pragma once

#include <vector>

#include "simulation/wayfinding/grid.hpp"

namespace holdfast::simulation {

/// Cheapest ways over the cells of a grid from one of them (Dijkstra).
class ShortestWays {
 public:
  /// `cost` is that of a metre in each cell, >= 1; infinite where there is no way.
  ShortestWays(const Grid& grid, const std::vector<float>& cost, std::size_t from);

  /// Infinite for what cannot be reached.
  const std::vector<float>& costs() const { return total_; }
  /// The reachable cell that costs most; of equals the one with the smallest number.
  std::size_t farthest() const;
  /// Cells from the start to `to`, both included. `to` can be reached.
  std::vector<std::size_t> way_to(std::size_t to) const;

 private:
  std::vector<float> total_;
  std::vector<std::uint32_t> before_;  ///< the cell from which each was reached
};

}  // namespace holdfast::simulation
