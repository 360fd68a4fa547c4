#include "simulation/wayfinding/grid.hpp"

#include <algorithm>
#include <limits>

namespace holdfast::simulation {
namespace {

/// Distances from the cells before and above, in the order of the sweep.
void sweep(const Grid& grid, std::vector<float>& distance, std::int32_t direction) {
  constexpr float kDiagonal = 1.41421356F;
  const std::int32_t rows = grid.height;
  for (std::int32_t j = 0; j < rows; ++j) {
    const std::int32_t y = direction > 0 ? j : rows - 1 - j;
    for (std::int32_t i = 0; i < grid.width; ++i) {
      const std::int32_t x = direction > 0 ? i : grid.width - 1 - i;
      float& here = distance[grid.index(x, y)];
      const auto take = [&](std::int32_t dx, std::int32_t dy, float step) {
        if (!grid.contains(x + dx, y + dy)) return;
        here = std::min(here, distance[grid.index(x + dx, y + dy)] + step);
      };
      take(-direction, 0, 1);
      take(0, -direction, 1);
      take(-1, -direction, kDiagonal);
      take(1, -direction, kDiagonal);
    }
  }
}

}  // namespace

std::vector<float> distances_to(const Grid& grid, const std::vector<bool>& sources) {
  std::vector<float> distance(grid.size(), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < distance.size(); ++i) {
    if (sources[i]) distance[i] = 0;
  }
  sweep(grid, distance, 1);
  sweep(grid, distance, -1);
  for (float& d : distance) d *= static_cast<float>(grid.cell_m);
  return distance;
}

}  // namespace holdfast::simulation
