#include "simulation/scenarios/town.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "holdfast/core/random.hpp"
#include "simulation/buildings/town_block.hpp"
#include "simulation/scenarios/all.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;

constexpr std::string_view kPrefix = "town:";
constexpr std::string_view kUnit = "km2";
constexpr int kMostColumns = 10;  // of meshes that the way goes round
constexpr int kMostRows = 6;
constexpr int kMostVehicles = 16;

/// Where the middles of the streets are along one axis; each depends on its number only.
std::vector<double> streets(int meshes, const char* axis, double least, double most) {
  std::vector<double> at = {0};
  for (int i = 0; i < meshes; ++i) {
    RandomStream random(static_cast<std::uint64_t>(i), axis);
    at.push_back(at.back() + random.uniform(least, most));
  }
  return at;
}

struct Grid {
  std::vector<double> x;
  std::vector<double> y;

  explicit Grid(double size_km2) {
    const double side = std::sqrt(size_km2 * 1e6);
    x = streets(std::max(3, static_cast<int>(std::lround(side * 1.12 / 75))), "town.x", 62, 88);
    y = streets(std::max(3, static_cast<int>(std::lround(side / 1.12 / 70))), "town.y", 58, 82);
  }
  int columns() const { return static_cast<int>(x.size()) - 1; }
  int rows() const { return static_cast<int>(y.size()) - 1; }
};

World build_blocks(const Grid& grid) {
  WorldBuilder build;
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      add_town_block(
          build,
          {column, row, {grid.x[column], grid.y[row]}, {grid.x[column + 1], grid.y[row + 1]}});
    }
  }
  return build.build();
}

/// `crossings` moved to the right of the way from each to the next.
std::vector<Vector2d> keep_right(const std::vector<Vector2d>& crossings, double aside) {
  std::vector<Vector2d> out;
  const std::size_t n = crossings.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d in = (crossings[i] - crossings[(i + n - 1) % n]).normalized();
    const Vector2d on = (crossings[(i + 1) % n] - crossings[i]).normalized();
    const auto right = [aside](const Vector2d& way) -> Vector2d {
      return aside * Vector2d(way.y(), -way.x());
    };
    out.push_back(crossings[i] + right(in) + right(on));
  }
  return out;
}

/// Along the second street, back along the third, and so on, home along the first that crosses
/// them: streets at the town's edge are not driven.
Route way_through(const Grid& grid) {
  const int last = std::min(grid.columns() - 1, kMostColumns);
  const int rows = std::min((grid.rows() - 1) / 2 * 2, kMostRows);
  std::vector<Vector2d> crossings;
  for (int row = 1; row <= rows; ++row) {
    const bool east = row % 2 == 1;
    const int first = row == 1 || row == rows ? 1 : 2;
    crossings.emplace_back(grid.x[east ? first : last], grid.y[row]);
    crossings.emplace_back(grid.x[east ? last : first], grid.y[row]);
  }
  return Route::closed(keep_right(crossings, kStripMiddle), 3.0);
}

/// Clockwise round meshes of the streets that the robot takes, two or three columns wide.
std::vector<VehiclePlan> traffic(const Grid& grid) {
  std::vector<VehiclePlan> plans;
  RandomStream random(1, "town.traffic");
  const int last = std::min(grid.columns() - 1, kMostColumns + 1);
  const int rows = std::min(grid.rows() - 1, kMostRows + 1);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column + 1 < last; column += 2) {
      if (static_cast<int>(plans.size()) == kMostVehicles) return plans;
      const double x0 = grid.x[column], x1 = grid.x[column + 2];
      const double y0 = grid.y[row], y1 = grid.y[row + 1];
      const std::vector<Vector2d> round = {{x0, y0}, {x0, y1}, {x1, y1}, {x1, y0}};
      const VehicleKind kind = kAllVehicleKinds[random.below(5) % kAllVehicleKinds.size()];
      plans.push_back(
          {Route::closed(keep_right(round, kLaneMiddle), 6.0), random.uniform(5, 9), kind});
    }
  }
  return plans;
}

}  // namespace

Scenario make_town(double size_km2) {
  const Grid grid(size_km2);
  Scenario scenario;
  scenario.name = "town";
  scenario.world = build_blocks(grid);
  scenario.route = way_through(grid);
  scenario.vehicles = traffic(grid);
  scenario.style.distance_m = std::min(1000.0, scenario.route.length());
  scenario.style.speed_m_s = 1.5;
  scenario.style.body_height_m = 0.6;
  scenario.style.sway_rad = 0.005;
  scenario.style.heave_m = 0.003;
  return scenario;
}

Scenario make_town() { return make_town(kTownKm2); }

Result<Scenario> make_town(std::string_view name) {
  if (!name.starts_with(kPrefix)) return make_town();
  const std::string_view size = name.substr(kPrefix.size());
  double km2 = 0;
  const auto read = std::from_chars(size.data(), size.data() + size.size(), km2);
  const bool whole =
      read.ec == std::errc() && std::string_view(read.ptr, size.data() + size.size()) == kUnit;
  if (!whole || !(km2 >= kSmallestTown && km2 <= kLargestTown)) {
    return Error{fmt::format("scenario '{}': expected town:SIZEkm2 with a size of {} to {}", name,
                             kSmallestTown, kLargestTown)};
  }
  return make_town(km2);
}

}  // namespace holdfast::simulation
