#include "simulation/wayfinding/walled_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "simulation/wayfinding/surface_samples.hpp"

namespace holdfast::simulation {
namespace {

constexpr double kCell = 0.5;
constexpr double kBaseCell = 4;  // of the heights, metres
constexpr int kBaseReach = 3;    // cells around whose lowest things tell a height
constexpr std::size_t kBaseFewest = 3;
constexpr double kBaseShare = 0.2;  // of those are lower
constexpr int kBaseSmoothings = 6;
constexpr float kLow = 0.3F;  // metres above the base that do not bar the way
constexpr float kHigh = 2;
constexpr int kDirections = 16;
constexpr int kWalled = 10;
constexpr double kSight = 25;  // metres
constexpr double kSightStep = 1;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

std::vector<float> lowest_of(const Grid& grid, const std::vector<SurfaceSample>& samples) {
  std::vector<float> low(grid.size(), kNone);
  for (const SurfaceSample& s : samples) {
    if (!(low[s.cell] <= s.z)) low[s.cell] = s.z;
  }
  return low;
}

/// Calls visit(cell) for those within `reach` cells of a cell, itself included.
template <class Visit>
void nearby(const Grid& grid, std::size_t i, int reach, const Visit& visit) {
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const std::int32_t x = grid.column(i) + dx;
      const std::int32_t y = grid.row(i) + dy;
      if (grid.contains(x, y)) visit(grid.index(x, y));
    }
  }
}

/// Height of the ground that is not there, over coarse cells; NaN far from everything.
std::vector<float> base_heights(const Grid& grid, const std::vector<float>& low) {
  std::vector<float> base(grid.size(), kNone);
  std::vector<float> around;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    around.clear();
    nearby(grid, i, kBaseReach, [&](std::size_t k) {
      if (!std::isnan(low[k])) around.push_back(low[k]);
    });
    if (around.size() < kBaseFewest) continue;
    const auto rank = static_cast<std::ptrdiff_t>(kBaseShare * static_cast<double>(around.size()));
    std::nth_element(around.begin(), around.begin() + rank, around.end());
    base[i] = around[static_cast<std::size_t>(rank)];
  }
  for (int pass = 0; pass < kBaseSmoothings; ++pass) {
    const std::vector<float> before = base;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      if (std::isnan(before[i])) continue;
      float sum = 0;
      int count = 0;
      nearby(grid, i, 2, [&](std::size_t k) {
        if (std::isnan(before[k])) return;
        sum += before[k];
        ++count;
      });
      base[i] = sum / static_cast<float>(count);
    }
  }
  return base;
}

/// Value at a place between the centres of coarse cells; NaN where one of them has none.
float between(const Grid& grid, const std::vector<float>& value, const Eigen::Vector2d& p) {
  const Eigen::Array2d at = ((p - grid.low) / grid.cell_m).array() - 0.5;
  const auto x = static_cast<std::int32_t>(
      std::clamp(std::floor(at.x()), 0.0, std::max(0.0, grid.width - 2.0)));
  const auto y = static_cast<std::int32_t>(
      std::clamp(std::floor(at.y()), 0.0, std::max(0.0, grid.height - 2.0)));
  const double u = std::clamp(at.x() - x, 0.0, 1.0);
  const double v = std::clamp(at.y() - y, 0.0, 1.0);
  const auto corner = [&](int dx, int dy) {
    const std::int32_t i = std::min(x + dx, grid.width - 1);
    const std::int32_t k = std::min(y + dy, grid.height - 1);
    return static_cast<double>(value[grid.index(i, k)]);
  };
  return static_cast<float>((1 - u) * (1 - v) * corner(0, 0) + u * (1 - v) * corner(1, 0) +
                            (1 - u) * v * corner(0, 1) + u * v * corner(1, 1));
}

std::vector<bool> barred_cells(const Ground& ground, const std::vector<SurfaceSample>& samples) {
  std::vector<bool> barred(ground.grid.size(), false);
  for (const SurfaceSample& s : samples) {
    const float over = s.z - ground.height[s.cell];
    if (over > kLow && over < kHigh) barred[s.cell] = true;
  }
  return barred;
}

/// True when there are things within sight in most directions.
bool is_walled(const Grid& grid, const std::vector<bool>& barred, std::size_t i) {
  int met = 0;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2 * std::numbers::pi * k / kDirections;
    const Eigen::Vector2d way(std::cos(angle), std::sin(angle));
    for (double gone = kSightStep; gone < kSight; gone += kSightStep) {
      const std::size_t there = grid.at(grid.center(i) + gone * way);
      if (there == grid.size()) break;
      if (!barred[there]) continue;
      ++met;
      break;
    }
  }
  return met >= kWalled;
}

}  // namespace

Ground find_walled_space(const World& world, const RobotReach& reach) {
  const Grid coarse = grid_over(world, kBaseCell);
  const auto base = base_heights(coarse, lowest_of(coarse, samples_of(world, coarse)));
  Ground space;
  space.grid = grid_over(world, kCell);
  const Grid& grid = space.grid;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    space.height.push_back(between(coarse, base, grid.center(i)));
  }
  const std::vector<bool> barred = barred_cells(space, samples_of(world, grid));
  space.room = distances_to(grid, barred);
  std::vector<bool> allowed(grid.size());
  for (std::size_t i = 0; i < grid.size(); ++i) {
    allowed[i] = !std::isnan(space.height[i]) && space.room[i] >= reach.radius_m + kCell &&
                 is_walled(grid, barred, i);
  }
  std::vector<std::size_t> largest;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (!allowed[i]) continue;
    auto part = connected_cells(grid, i, allowed);
    if (part.size() > largest.size()) largest = std::move(part);
  }
  space.usable.assign(grid.size(), false);
  for (const std::size_t i : largest) space.usable[i] = true;
  return space;
}

}  // namespace holdfast::simulation
