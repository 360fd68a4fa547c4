#pragma once

#include <vector>

#include "simulation/wayfinding/grid.hpp"
#include "simulation/world/world.hpp"

namespace holdfast::simulation {

/// A piece of surface over a cell. Sorted by cell, and upwards in each.
struct SurfaceSample {
  std::uint32_t cell = 0;
  float z = 0;
  bool faces_up = false;  ///< its front does, and one who sees it from below is within a solid

  bool operator<(const SurfaceSample& other) const {
    return cell != other.cell ? cell < other.cell : z < other.z;
  }
};

/// A grid over the world with cells of `cell_m`, larger only where that would make more than 20
/// million; without cells when the world is empty.
Grid grid_over(const World& world, double cell_m);

/// The world's triangles at points not more than half a cell apart, and the centres of its discs.
std::vector<SurfaceSample> samples_of(const World& world, const Grid& grid);

/// Cells from `seed` on over cells of `allowed`, which are taken out of it.
std::vector<std::size_t> connected_cells(const Grid& grid, std::size_t seed,
                                         std::vector<bool>& allowed);

}  // namespace holdfast::simulation
