#include "simulation/wayfinding/found_route.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "simulation/wayfinding/ground.hpp"
#include "simulation/wayfinding/shortest_way.hpp"
#include "simulation/wayfinding/walled_space.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Line = std::vector<Vector2d>;  // closed

constexpr double kComfort = 2;      // metres to things beyond which a way costs no more
constexpr double kCrampedCost = 2;  // added to the cost of a metre without any room
constexpr double kOtherWay = 5;     // metres from the way out within which going back costs more
constexpr double kSameWayCost = 3;  // added to the cost of a metre on the way out
constexpr double kStep = 0.5;       // metres between the points of a line
constexpr double kLane = 0.6;       // metres to the right
constexpr double kShortest = 8;     // metres of a way worth driving
constexpr double kShortWay = 60;    // of which one asks whether the ground was taken out
constexpr double kMuchFarther = 4;  // times as far it goes between things without a ground
constexpr double kHeightReach = 1;  // metres around a place over which its height is averaged
constexpr int kHeightMean = 8;      // corners over which heights are averaged, 0.5 m apart
constexpr int kSmoothings = 20;
constexpr std::size_t kAhead = 4;    // points on both sides that tell a line's direction
constexpr double kWidestArc = 1000;  // a rounding as wide as the corners' distance allows
constexpr float kNoWay = std::numeric_limits<float>::infinity();

/// Cost of a metre in each cell.
std::vector<float> costs_of(const Ground& ground) {
  std::vector<float> cost(ground.grid.size(), kNoWay);
  for (std::size_t i = 0; i < cost.size(); ++i) {
    if (!ground.usable[i]) continue;
    const double cramped = std::max(0.0, 1 - ground.room[i] / kComfort);
    cost[i] = static_cast<float>(1 + kCrampedCost * cramped);
  }
  return cost;
}

std::size_t nearest_to_middle(const Ground& ground) {
  const Grid& grid = ground.grid;
  const Vector2d middle = grid.low + 0.5 * grid.cell_m * Vector2d(grid.width, grid.height);
  std::size_t best = grid.size();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double there = (grid.center(i) - middle).squaredNorm();
    if (!ground.usable[i] || there >= least) continue;
    least = there;
    best = i;
  }
  return best;
}

/// Cells out and back again, closed.
struct Loop {
  std::vector<std::size_t> cells;
  double shared_share = 0;
};

Loop long_loop(const Ground& ground) {
  const Grid& grid = ground.grid;
  std::vector<float> even(grid.size(), kNoWay);
  for (std::size_t i = 0; i < even.size(); ++i) even[i] = ground.usable[i] ? 1.0F : kNoWay;
  const std::size_t one_end = ShortestWays(grid, even, nearest_to_middle(ground)).farthest();
  const std::size_t other_end = ShortestWays(grid, even, one_end).farthest();
  std::vector<float> cost = costs_of(ground);
  Loop loop{ShortestWays(grid, cost, one_end).way_to(other_end), 0};
  std::vector<bool> out(grid.size(), false);
  for (const std::size_t i : loop.cells) out[i] = true;
  const std::vector<float> off = distances_to(grid, out);
  for (std::size_t i = 0; i < cost.size(); ++i) {
    cost[i] += static_cast<float>(kSameWayCost * std::max(0.0, 1 - off[i] / kOtherWay));
  }
  const auto back = ShortestWays(grid, cost, other_end).way_to(one_end);
  double shared = 0;
  for (const std::size_t i : back) shared += off[i] < 1 ? 1 : 0;
  loop.shared_share = shared / static_cast<double>(back.size());
  loop.cells.insert(loop.cells.end(), back.begin() + 1, back.end() - 1);
  return loop;
}

double length_of(const Line& line) {
  double sum = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    sum += (line[(i + 1) % line.size()] - line[i]).norm();
  }
  return sum;
}

/// Points about kStep apart along the line.
Line evenly(const Line& line) {
  const double length = length_of(line);
  const auto count = std::max<std::size_t>(8, static_cast<std::size_t>(length / kStep));
  const double step = length / static_cast<double>(count);
  Line out;
  double gone = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vector2d way = line[(i + 1) % line.size()] - line[i];
    const double piece = way.norm();
    while (out.size() < count && static_cast<double>(out.size()) * step < gone + piece) {
      const double along = static_cast<double>(out.size()) * step - gone;
      out.push_back(line[i] + way * (along / piece));
    }
    gone += piece;
  }
  return out;
}

/// Draws each point towards the middle of its neighbours, where there is room.
void smooth(Line& line, const Ground& ground, double radius) {
  for (int pass = 0; pass < kSmoothings; ++pass) {
    const Line before = line;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const Vector2d& last = before[(i + line.size() - 1) % line.size()];
      const Vector2d& next = before[(i + 1) % line.size()];
      const Vector2d drawn = 0.5 * before[i] + 0.25 * (last + next);
      if (ground.room_at(drawn) >= radius) line[i] = drawn;
    }
  }
}

/// Moves each point to the right as far as there is room.
Line kept_right(const Line& line, const Ground& ground, double radius) {
  Line out;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const std::size_t n = line.size();
    const Vector2d way = line[(i + kAhead) % n] - line[(i + n - kAhead) % n];
    const double length = way.norm();
    const Vector2d right =
        length > 1e-6 ? Vector2d(way.y() / length, -way.x() / length) : Vector2d::Zero();
    const double lane = std::clamp(ground.room_at(line[i]) - radius, 0.05, kLane);
    out.emplace_back(line[i] + lane * right);
  }
  return out;
}

/// Heights under the points, averaged along the way.
std::vector<double> heights_under(const Line& line, const Ground& ground) {
  const auto n = static_cast<int>(line.size());
  std::vector<double> own;
  for (const Vector2d& p : line) {
    const double height = ground.height_at(p, kHeightReach);
    own.push_back(std::isfinite(height) || own.empty() ? height : own.back());
  }
  std::vector<double> out;
  for (int i = 0; i < n; ++i) {
    double sum = 0;
    for (int k = -kHeightMean / 2; k <= kHeightMean / 2; ++k) {
      sum += own[static_cast<std::size_t>(((i + k) % n + n) % n)];
    }
    out.push_back(sum / (kHeightMean + 1));
  }
  return out;
}

Route route_along(const Line& line, const Ground& ground) {
  const std::vector<double> height = heights_under(line, ground);
  std::vector<RouteCorner> corners;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (!corners.empty() && (corners.back().position.head<2>() - line[i]).norm() < 1e-3) continue;
    corners.push_back({{line[i].x(), line[i].y(), height[i]}, kWidestArc});
  }
  return Route::closed(corners);
}

/// The loop through a space, and how long it is before it is smoothed.
struct Way {
  Ground ground;
  Loop loop;
  Line line;
  double length_m = 0;
};

Way way_through(Ground ground) {
  Way way{std::move(ground), {}, {}, 0};
  const auto& usable = way.ground.usable;
  if (std::none_of(usable.begin(), usable.end(), [](bool b) { return b; })) return way;
  way.loop = long_loop(way.ground);
  for (const std::size_t cell : way.loop.cells) way.line.push_back(way.ground.grid.center(cell));
  way.length_m = length_of(way.line);
  return way;
}

}  // namespace

Result<FoundRoute> find_route(const World& world) {
  const RobotReach reach;
  Way way = way_through(find_ground(world, reach));
  bool on_ground = true;
  if (way.length_m < kShortWay) {
    Way walled = way_through(find_walled_space(world, reach));
    on_ground = walled.length_m <= kMuchFarther * way.length_m;
    if (!on_ground) way = std::move(walled);
  }
  if (way.length_m < kShortest) {
    return Error{fmt::format(
        "route: expected connected ground for a closed way of {} m, found one of {:.1f} m",
        kShortest, way.length_m)};
  }
  Line line = evenly(kept_right(evenly(way.line), way.ground, reach.radius_m));
  smooth(line, way.ground, reach.radius_m);
  FoundRoute found{route_along(evenly(line), way.ground), 0, way.loop.shared_share, on_ground};
  found.length_m = found.route.length();
  return found;
}

}  // namespace holdfast::simulation
