#include "simulation/wayfinding/found_route.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "simulation/files/scenario_file.hpp"
#include "simulation/wayfinding/ground.hpp"
#include "simulation/wayfinding/shortest_way.hpp"
#include "simulation/world/world_builder.hpp"
#include "tests/simulation/world_files.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRadius = RobotReach{}.radius_m;
// Cells are 0.25 m, their distances are known to a cell's diagonal, and arcs cut corners of 0.5 m.
constexpr double kCells = 0.25 * M_SQRT2 + 0.1;

void add_room(WorldBuilder& build, const Vector2d& size) {
  build.floor({0, 0}, size, 0, materials::kConcrete);
  const Vector2d corners[] = {{0, 0}, {size.x(), 0}, size, {0, size.y()}};
  for (int i = 0; i < 4; ++i) {
    build.wall({corners[i], corners[(i + 1) % 4], 0, 3, materials::kPlaster, {}});
  }
}

FoundRoute found(WorldBuilder& build) {
  auto route = find_route(build.build());
  EXPECT_TRUE(route) << route.error().message;
  return std::move(*route);
}

/// Calls visit(place) each 10 cm.
template <class Visit>
void along(const Route& route, const Visit& visit) {
  for (double s = 0; s < route.length(); s += 0.1) visit(route.at(s));
}

TEST(FoundRoute, KeepsARobotsRadiusFromTheWallsOfARoom) {
  WorldBuilder build;
  add_room(build, {12, 8});
  const FoundRoute way = found(build);
  along(way.route, [&](const Route::Place& place) {
    const Vector2d p = place.position.head<2>();
    const double wall = std::min(p.minCoeff(), (Vector2d(12, 8) - p).minCoeff());
    EXPECT_GT(wall, kRadius - kCells);
    EXPECT_NEAR(place.position.z(), 0, 1e-5);
  });
  EXPECT_GT(way.length_m, 12);  // out and back along most of the diagonal of 14.4 m
  EXPECT_EQ(way.length_m, way.route.length());
}

TEST(FoundRoute, GoesRoundWhereThereIsAnotherWayBack) {
  WorldBuilder build;  // a ring of 4 m about a block
  add_room(build, {40, 20});
  build.box({{20, 10, 1.5}, {32, 12, 3}}, materials::kConcrete);
  const FoundRoute way = found(build);
  EXPECT_LT(way.shared_share, 0.1);
  // Once round: between the block's outline and the room's.
  EXPECT_GT(way.length_m, 2 * (32 + 12));
  EXPECT_LT(way.length_m, 2 * (40 + 20));
}

TEST(FoundRoute, GoesThereAndBackInTwoLanesOfADeadEnd) {
  WorldBuilder build;
  add_room(build, {40, 3});
  const FoundRoute way = found(build);
  EXPECT_GT(way.length_m, 2 * (40 - 2 * (kRadius + 1) - 3));
  EXPECT_LT(way.length_m, 2 * 40);
  double left = 0, right = 0;
  along(way.route, [&](const Route::Place& place) {
    if (std::abs(place.position.x() - 20) > 10) return;
    // On the right hand: below the middle on the way to +x.
    const double side = (place.position.y() - 1.5) * (std::cos(place.heading) > 0 ? -1 : 1);
    EXPECT_GT(side, 0);
    (std::cos(place.heading) > 0 ? right : left) += 0.1;
  });
  EXPECT_NEAR(left, 20, 0.5);
  EXPECT_NEAR(right, 20, 0.5);
}

TEST(FoundRoute, DoesNotClimbStepsOrPassUnderLowBeams) {
  const auto reaches = [](double block_height, double beam_bottom) {
    WorldBuilder build;
    add_room(build, {30, 6});
    build.box({{20, 3, 0.5 * block_height}, {2, 6, block_height}}, materials::kConcrete);
    build.box({{20, 3, beam_bottom + 0.2}, {0.5, 6, 0.4}}, materials::kConcrete);
    double farthest = 0;
    along(found(build).route,
          [&](const Route::Place& place) { farthest = std::max(farthest, place.position.x()); });
    return farthest;
  };
  EXPECT_GT(reaches(0.1, 2.0), 25);
  EXPECT_LT(reaches(0.5, 2.3), 19);
  EXPECT_LT(reaches(0.1, 1.2), 20);
}

TEST(FoundRoute, TakesItsHeightsFromTheGround) {
  WorldBuilder build;
  const Vector3d a(0, 0, 0), b(60, 0, 6), c(60, 10, 6), d(0, 10, 0);
  build.quad(a, b, c, d, materials::kAsphalt);
  const FoundRoute way = found(build);
  double low = 1e9, high = -1e9;
  along(way.route, [&](const Route::Place& place) {
    EXPECT_NEAR(place.position.z(), 0.1 * place.position.x(), 0.1);
    low = std::min(low, place.position.x());
    high = std::max(high, place.position.x());
  });
  EXPECT_GT(high - low, 45);
}

TEST(FoundRoute, TooSteepGroundIsNoWay) {
  WorldBuilder build;
  build.quad({0, 0, 0}, {60, 0, 30}, {60, 10, 30}, {0, 10, 0}, materials::kAsphalt);
  const auto route = find_route(build.build());
  ASSERT_FALSE(route);
  EXPECT_NE(route.error().message.find("expected connected ground"), std::string::npos);
  EXPECT_FALSE(find_route(World()));
}

TEST(FoundRoute, TakesTheLargerOfTwoGroundsThatDoNotMeet) {
  WorldBuilder build;
  build.floor({0, 0}, {20, 10}, 0, materials::kAsphalt);
  build.floor({20, 0}, {60, 10}, 1, materials::kAsphalt);
  along(found(build).route,
        [](const Route::Place& place) { EXPECT_NEAR(place.position.z(), 1, 1e-5); });
}

// Two rows of poles along a street of 12 m, as a map shows it from which the ground was taken.
TEST(FoundRoute, GoesBetweenThingsWhereTheGroundWasTakenOut) {
  WorldBuilder build;
  for (double x = 0; x <= 200; x += 2) {
    for (const double y : {0.0, 12.0}) {
      build.cylinder({x, y, 0.02 * x}, 0.3, 5, materials::kWood, 8);
    }
  }
  const FoundRoute way = found(build);
  EXPECT_FALSE(way.on_ground);
  EXPECT_GT(way.length_m, 2 * (200 - 2 * 25));
  along(way.route, [](const Route::Place& place) {
    const Vector3d& p = place.position;
    EXPECT_GT(p.y(), 0.3 + kRadius);
    EXPECT_LT(p.y(), 12 - 0.3 - kRadius);
    // The lower fifth of what stands within 14 m, and the mean of 25 m beyond the ends.
    EXPECT_NEAR(p.z(), 0.02 * p.x(), 0.02 * 25);
  });
}

TEST(ShortestWays, AreThoseOfTheGrid) {
  Grid grid{{0, 0}, 1, 5, 4};
  std::vector<float> cost(grid.size(), 1);
  for (std::int32_t y = 0; y < 3; ++y) {
    cost[grid.index(2, y)] = std::numeric_limits<float>::infinity();
  }
  const ShortestWays ways(grid, cost, grid.index(0, 0));
  // To row 3 beside the wall, through the gap, and down again: four diagonals and two straights.
  EXPECT_NEAR(ways.costs()[grid.index(4, 0)], 4 * M_SQRT2 + 2, 1e-5);
  EXPECT_EQ(ways.way_to(grid.index(4, 0)).size(), 7U);
  EXPECT_TRUE(std::isinf(ways.costs()[grid.index(2, 0)]));
}

TEST(AutoRoute, OfAScenarioFileIsFoundAndSaidInARemark) {
  const testing::WorldFolder folder;
  const auto file =
      folder.write("shed.yaml", "world: [floor: {min: [0, 0], max: [40, 20]}]\nroute: auto\n");
  const auto scenario = read_scenario_file(file);
  ASSERT_TRUE(scenario) << scenario.error().message;
  EXPECT_NE(scenario->remark.find(fmt::format("{:.0f} m long", scenario->route.length())),
            std::string::npos)
      << scenario->remark;
  const auto none = read_scenario_file(folder.write("none.yaml", "world: []\nroute: auto\n"));
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("none.yaml:2: route: expected connected ground"),
            std::string::npos)
      << none.error().message;
}

TEST(AutoRoute, LeadsThroughAMeshGivenAsAScenario) {
  const testing::WorldFolder folder;
  const auto file =
      folder.write("field.obj", "v 0 0 1\nv 30 0 1\nv 30 20 1\nv 0 20 1\nf 1 2 3 4\n");
  const auto scenario = make_scenario(file.string());
  ASSERT_TRUE(scenario) << scenario.error().message;
  EXPECT_EQ(scenario->name, "field");
  EXPECT_NEAR(scenario->route.at(3).position.z(), 1, 1e-5);
  const auto none = make_scenario((folder.path() / "none.pcd").string());
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("none.pcd"), std::string::npos);
}

}  // namespace
}  // namespace holdfast::simulation
