#include "simulation/wayfinding/ground.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kCell = 0.25;
constexpr double kMostCells = 2e7;
constexpr int kFillings = 3;
constexpr int kEnoughNeighbours = 5;
constexpr int kSmoothings = 2;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kFall = 1;          // metres
constexpr double kFacesUp = 0.3;    // vertical part of the normal
constexpr float kThickness = 0.1F;  // of what counts as one surface, metres

/// A piece of surface over a cell. Sorted by cell, and upwards in each.
struct Sample {
  std::uint32_t cell = 0;
  float z = 0;
  bool faces_up = false;  ///< its front does, and one who sees it from below is within a solid

  bool operator<(const Sample& other) const {
    return cell != other.cell ? cell < other.cell : z < other.z;
  }
};

Grid grid_over(const World& world) {
  Eigen::AlignedBox3f box;
  for (const auto& triangle : world.triangles) {
    for (const std::uint32_t k : triangle) box.extend(world.vertices[k]);
  }
  for (const Disc& disc : world.discs) box.extend(disc.center);
  Grid grid;
  if (box.isEmpty()) return grid;
  const Vector3d size = box.sizes().cast<double>();
  grid.cell_m = std::max(kCell, std::sqrt(size.x() * size.y() / kMostCells));
  grid.low = box.min().cast<double>().head<2>();
  grid.width = static_cast<std::int32_t>(size.x() / grid.cell_m) + 1;
  grid.height = static_cast<std::int32_t>(size.y() / grid.cell_m) + 1;
  return grid;
}

/// Heights of surfaces over cells.
class Samples {
 public:
  explicit Samples(const Grid& grid) : grid_(grid) {}

  void add(const Vector3d& p, bool faces_up = false) {
    const std::size_t cell = grid_.at(p.head<2>());
    if (cell == grid_.size()) return;
    all_.push_back({static_cast<std::uint32_t>(cell), static_cast<float>(p.z()), faces_up});
  }

  /// Points of a triangle not more than half a cell apart.
  void add_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double step = 0.5 * grid_.cell_m;
    const bool faces_up = (b - a).cross(c - a).normalized().z() > kFacesUp;
    const int rows = 1 + static_cast<int>(std::max((b - a).norm(), (c - a).norm()) / step);
    for (int i = 0; i <= rows; ++i) {
      const double u = static_cast<double>(i) / rows;
      const Vector3d from = a + u * (b - a);
      const Vector3d to = a + u * (c - a);
      const int columns = 1 + static_cast<int>((to - from).norm() / step);
      for (int k = 0; k <= columns; ++k) add(from + (to - from) * k / columns, faces_up);
    }
  }

  std::vector<Sample> sorted() {
    std::stable_sort(all_.begin(), all_.end());
    return std::move(all_);
  }

 private:
  const Grid& grid_;
  std::vector<Sample> all_;
};

std::vector<Sample> samples_of(const World& world, const Grid& grid) {
  Samples samples(grid);
  for (const auto& triangle : world.triangles) {
    const auto corner = [&](int k) -> Vector3d {
      return world.vertices[triangle[k]].cast<double>();
    };
    samples.add_triangle(corner(0), corner(1), corner(2));
  }
  for (const Disc& disc : world.discs) samples.add(disc.center.cast<double>());
  return samples.sorted();
}

/// True when the next surface above is seen from behind only.
bool is_within_solid(const Sample* low, const Sample* end, const RobotReach& reach) {
  const Sample* next = low;
  while (next != end && next->z <= low->z + reach.low_m) ++next;
  if (next == end) return false;
  const float height = next->z;
  for (; next != end && next->z <= height + kThickness; ++next) {
    if (!next->faces_up) return false;
  }
  return true;
}

/// Height of the ground whose lowest sample is `low`: what lies on it and is low belongs to it.
float top_of(const Sample* low, const Sample* end, const RobotReach& reach) {
  const Sample* top = low;
  while (top + 1 != end && top[1].z <= low->z + reach.low_m) ++top;
  float sum = 0;
  int count = 0;
  for (const Sample* s = low; s <= top; ++s) {
    if (s->z < top->z - kThickness) continue;
    sum += s->z;
    ++count;
  }
  return sum / static_cast<float>(count);
}

/// The lowest of a cell's heights with head room above it; the top one has it always.
float lowest_with_headroom(const Sample* begin, const Sample* end, const RobotReach& reach) {
  for (const Sample* low = begin; low != end; ++low) {
    const auto blocks = [&](const Sample& other) {
      const float over = other.z - low->z;
      return over > reach.low_m && over < reach.headroom_m;
    };
    if (std::any_of(low, end, blocks) || is_within_solid(low, end, reach)) continue;
    return top_of(low, end, reach);
  }
  return kNone;
}

std::vector<float> lowest_surfaces(const Grid& grid, const std::vector<Sample>& samples,
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

/// Cells that can be reached from `seed` over cells of `allowed`, which are taken out of it.
std::vector<std::size_t> connected(const Grid& grid, std::size_t seed, std::vector<bool>& allowed) {
  std::vector<std::size_t> found = {seed};
  allowed[seed] = false;
  for (std::size_t next = 0; next < found.size(); ++next) {
    grid.around(found[next], [&](std::size_t k, double) {
      if (!allowed[k]) return;
      allowed[k] = false;
      found.push_back(k);
    });
  }
  return found;
}

/// Metres to the nearest brink: a cell beside which it goes down further than a robot may fall.
std::vector<float> distances_to_brinks(const Ground& ground) {
  const Grid& grid = ground.grid;
  std::vector<bool> brink(grid.size(), false);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    grid.around(i, [&](std::size_t k, double) {
      if (ground.height[k] < ground.height[i] - kFall) brink[i] = true;
    });
  }
  return distances_to(grid, brink);
}

/// True when most of a part's rim is a brink: the part is a roof.
bool is_raised(const Ground& ground, const std::vector<std::size_t>& part,
               const std::vector<float>& to_brink) {
  const double cell = ground.grid.cell_m;
  const double least_room =
      ground.room[*std::min_element(part.begin(), part.end(), [&](std::size_t a, std::size_t b) {
        return ground.room[a] < ground.room[b];
      })];
  std::size_t rim = 0;
  std::size_t brinks = 0;
  for (const std::size_t i : part) {
    if (ground.room[i] > least_room + cell) continue;
    ++rim;
    brinks += to_brink[i] < ground.room[i] + 3 * cell ? 1U : 0U;
  }
  return 2 * brinks > rim;
}

/// The largest part that is no roof, or the largest roof when there is nothing else.
std::vector<bool> largest_part(const Ground& ground, std::vector<bool> allowed) {
  const std::vector<float> to_brink = distances_to_brinks(ground);
  std::vector<std::size_t> largest;
  bool raised = true;
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    if (!allowed[i]) continue;
    auto part = connected(ground.grid, i, allowed);
    if (part.size() <= largest.size() && !raised) continue;
    const bool raised_too = is_raised(ground, part, to_brink);
    if (raised_too && (!raised || part.size() <= largest.size())) continue;
    largest = std::move(part);
    raised = raised_too;
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
  ground.grid = grid_over(world);
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
