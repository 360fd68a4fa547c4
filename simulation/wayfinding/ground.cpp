#include "simulation/wayfinding/ground.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simulation/wayfinding/surface_samples.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kCell = 0.25;
constexpr int kFillings = 3;
constexpr int kEnoughNeighbours = 5;
constexpr int kSmoothings = 2;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kFall = 1;           // metres
constexpr double kBesideBrink = 2;   // metres
constexpr double kRoofWorth = 0.05;  // of its size, against ground that is no roof
constexpr float kThickness = 0.1F;   // of what counts as one surface, metres

/// True when the next surface above is seen from behind only.
bool is_within_solid(const SurfaceSample* low, const SurfaceSample* end, const RobotReach& reach) {
  const SurfaceSample* next = low;
  while (next != end && next->z <= low->z + reach.low_m) ++next;
  if (next == end) return false;
  const float height = next->z;
  for (; next != end && next->z <= height + kThickness; ++next) {
    if (!next->faces_up) return false;
  }
  return true;
}

/// Height of the ground whose lowest sample is `low`: what lies on it and is low belongs to it.
float top_of(const SurfaceSample* low, const SurfaceSample* end, const RobotReach& reach) {
  const SurfaceSample* top = low;
  while (top + 1 != end && top[1].z <= low->z + reach.low_m) ++top;
  float sum = 0;
  int count = 0;
  for (const SurfaceSample* s = low; s <= top; ++s) {
    if (s->z < top->z - kThickness) continue;
    sum += s->z;
    ++count;
  }
  return sum / static_cast<float>(count);
}

/// The lowest of a cell's heights with head room above it; the top one has it always.
float lowest_with_headroom(const SurfaceSample* begin, const SurfaceSample* end,
                           const RobotReach& reach) {
  for (const SurfaceSample* low = begin; low != end; ++low) {
    const auto blocks = [&](const SurfaceSample& other) {
      const float over = other.z - low->z;
      return over > reach.low_m && over < reach.headroom_m;
    };
    if (std::any_of(low, end, blocks) || is_within_solid(low, end, reach)) continue;
    return top_of(low, end, reach);
  }
  return kNone;
}

std::vector<float> lowest_surfaces(const Grid& grid, const std::vector<SurfaceSample>& samples,
                                   const RobotReach& reach) {
  std::vector<float> height(grid.size(), kNone);
  for (std::size_t i = 0; i < samples.size();) {
    std::size_t end = i;
    while (end < samples.size() && samples[end].cell == samples[i].cell) ++end;
    height[samples[i].cell] = lowest_with_headroom(samples.data() + i, samples.data() + end, reach);
    i = end;
  }
  return height;
}

/// Gives cells without a surface the mean of their neighbours.
void fill_gaps(const Grid& grid, std::vector<float>& height) {
  const std::vector<float> before = height;
  for (std::size_t i = 0; i < height.size(); ++i) {
    if (!std::isnan(before[i])) continue;
    float sum = 0;
    int count = 0;
    grid.around(i, [&](std::size_t k, double) {
      if (std::isnan(before[k])) return;
      sum += before[k];
      ++count;
    });
    if (count >= kEnoughNeighbours) height[i] = sum / static_cast<float>(count);
  }
}

/// Takes the mean of the cells around that lie within a step.
void smooth(const Grid& grid, double step, std::vector<float>& height) {
  const std::vector<float> before = height;
  for (std::size_t i = 0; i < height.size(); ++i) {
    if (std::isnan(before[i])) continue;
    float sum = before[i];
    int count = 1;
    grid.around(i, [&](std::size_t k, double) {
      if (!(std::abs(before[k] - before[i]) <= step)) return;
      sum += before[k];
      ++count;
    });
    height[i] = sum / static_cast<float>(count);
  }
}

/// True where a wheel may stand: ground without a step beside it, and not steep.
bool is_drivable(const Ground& ground, std::size_t i, const RobotReach& reach) {
  const Grid& grid = ground.grid;
  const std::int32_t x = grid.column(i);
  const std::int32_t y = grid.row(i);
  const auto at = [&](std::int32_t dx, std::int32_t dy) {
    return grid.contains(x + dx, y + dy) ? ground.height[grid.index(x + dx, y + dy)] : kNone;
  };
  for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
    if (!(std::abs(at(dx, dy) - at(0, 0)) <= reach.most_step_m)) return false;
  }
  const int half = std::max(1, static_cast<int>(std::lround(0.5 / grid.cell_m)));
  const double run = 2 * half * grid.cell_m;
  const double slope_x = (at(half, 0) - at(-half, 0)) / run;
  const double slope_y = (at(0, half) - at(0, -half)) / run;
  return !(std::hypot(slope_x, slope_y) > reach.most_slope);
}

/// True when the ground near a cell lies lower than a robot may fall.
bool is_at_brink(const Ground& ground, std::size_t i) {
  const Grid& grid = ground.grid;
  const auto reach = static_cast<std::int32_t>(kBesideBrink / grid.cell_m);
  for (std::int32_t y = grid.row(i) - reach; y <= grid.row(i) + reach; ++y) {
    for (std::int32_t x = grid.column(i) - reach; x <= grid.column(i) + reach; ++x) {
      if (!grid.contains(x, y)) continue;
      if (ground.height[grid.index(x, y)] < ground.height[i] - kFall) return true;
    }
  }
  return false;
}

/// True when most of a part's rim lies at a brink: the part is a roof.
bool is_raised(const Ground& ground, const std::vector<std::size_t>& part) {
  float least_room = std::numeric_limits<float>::infinity();
  for (const std::size_t i : part) least_room = std::min(least_room, ground.room[i]);
  std::size_t rim = 0;
  std::size_t brinks = 0;
  for (const std::size_t i : part) {
    if (ground.room[i] > least_room + ground.grid.cell_m) continue;
    ++rim;
    brinks += is_at_brink(ground, i) ? 1U : 0U;
  }
  return 2 * brinks > rim;
}

/// The largest part, where a roof counts for less than it is.
std::vector<bool> largest_part(const Ground& ground, std::vector<bool> allowed) {
  std::vector<std::size_t> largest;
  double most = 0;
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    if (!allowed[i]) continue;
    auto part = connected_cells(ground.grid, i, allowed);
    const double worth = is_raised(ground, part) ? kRoofWorth : 1;
    if (worth * static_cast<double>(part.size()) <= most) continue;
    most = worth * static_cast<double>(part.size());
    largest = std::move(part);
  }
  std::vector<bool> out(ground.grid.size(), false);
  for (const std::size_t i : largest) out[i] = true;
  return out;
}

}  // namespace

double Ground::room_at(const Vector2d& p) const {
  const std::size_t cell = grid.at(p);
  return cell == grid.size() ? 0 : room[cell];
}

double Ground::height_at(const Vector2d& p, double radius) const {
  const std::size_t here = grid.at(p);
  if (here == grid.size() || std::isnan(height[here])) return kNone;
  const int reach = static_cast<int>(radius / grid.cell_m);
  double sum = 0;
  int count = 0;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const std::int32_t x = grid.column(here) + dx;
      const std::int32_t y = grid.row(here) + dy;
      if (std::hypot(dx, dy) > reach || !grid.contains(x, y)) continue;
      const float there = height[grid.index(x, y)];
      if (!(std::abs(there - height[here]) <= RobotReach{}.most_slope * radius + 0.1)) continue;
      sum += there;
      ++count;
    }
  }
  return sum / count;
}

Ground find_ground(const World& world, const RobotReach& reach) {
  Ground ground;
  ground.grid = grid_over(world, kCell);
  const Grid& grid = ground.grid;
  ground.height = lowest_surfaces(grid, samples_of(world, grid), reach);
  for (int i = 0; i < kFillings; ++i) fill_gaps(grid, ground.height);
  for (int i = 0; i < kSmoothings; ++i) smooth(grid, reach.most_step_m, ground.height);
  std::vector<bool> barred(grid.size());
  for (std::size_t i = 0; i < grid.size(); ++i) barred[i] = !is_drivable(ground, i, reach);
  ground.room = distances_to(grid, barred);
  std::vector<bool> allowed(grid.size());
  for (std::size_t i = 0; i < grid.size(); ++i) {
    allowed[i] = ground.room[i] >= reach.radius_m && std::isfinite(ground.height[i]);
  }
  ground.usable = largest_part(ground, std::move(allowed));
  return ground;
}

}  // namespace holdfast::simulation
