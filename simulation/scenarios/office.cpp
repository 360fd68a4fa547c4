#include <numbers>

#include "simulation/scenarios/all.hpp"
#include "simulation/world/furniture.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kQuarter = 0.5 * std::numbers::pi;
const Vector2d kSize(10, 8);
constexpr double kHeight = 2.7;

void add_room(WorldBuilder& build) {
  const Material& plaster = materials::kPlaster;
  const auto window = [](double start) {
    return WallOpening{start, 1.8, 0.85, 2.2, 0.2, false, materials::kFabric};  // blinds are down
  };
  build.floor({0, 0}, kSize, 0, materials::kCarpet);
  build.ceiling({0, 0}, kSize, kHeight, materials::kCeilingTile);
  build.wall({{0, 0}, {10, 0}, 0, kHeight, plaster, {{8.3, 1.0, 0, 2.1, 0.12}}});
  build.wall({{10, 0}, {10, 8}, 0, kHeight, plaster, {{0.6, 1.0, 0, 2.1, 0.12}}});
  build.wall({{10, 8}, {0, 8}, 0, kHeight, plaster, {window(0.9), window(4.1), window(7.2)}});
  build.wall({{0, 8}, {0, 0}, 0, kHeight, plaster, {}});
  build.box({{10 - 0.15, 8 - 0.2, 0.5 * kHeight}, {0.3, 0.4, kHeight}}, plaster);
  build.box({{0.2, 0.15, 0.5 * kHeight}, {0.4, 0.3, kHeight}}, plaster);
}

/// Four desks, two and two back to back with a partition between.
void add_island(WorldBuilder& build, double x) {
  for (const double y : {3.29, 4.71}) {
    add_desk(build, {{x - 0.4, y}, 0});
    add_desk(build, {{x + 0.4, y}, kHalfTurn});
  }
  add_partition(build, {{x, 4.0}, 0}, 2.8, 1.25);
}

void add_furniture(WorldBuilder& build) {
  add_island(build, 3.25);
  add_island(build, 6.75);
  add_chair(build, {{2.58, 4.75}, 0.3});
  add_chair(build, {{5.95, 3.2}, 0.15});
  add_chair(build, {{5.92, 4.8}, -0.3});
  add_chair(build, {{7.42, 3.3}, kHalfTurn + 0.4});
  for (const double y : {2.1, 3.0, 5.4}) add_cabinet(build, {{0.21, y}, 0}, 0.85, 1.9);
  add_cabinet(build, {{9.79, 3.4}, kHalfTurn}, 1.2, 1.2);
  add_cabinet(build, {{9.79, 5.6}, kHalfTurn}, 0.9, 1.9);
  add_cabinet(build, {{3.2, 0.21}, kQuarter}, 1.6, 0.8);
  add_cabinet(build, {{6.1, 0.21}, kQuarter}, 1.0, 1.6);
  add_wall_box(build, {{4.6, 0}, kQuarter}, 0.9, {0.05, 1.2, 0.9}, materials::kFabric);
  add_plant(build, {0.5, 7.5});
}

Route rectangle(const Vector2d& min, const Vector2d& max) {
  return Route::closed(
      {{min.x(), min.y()}, {max.x(), min.y()}, {max.x(), max.y()}, {min.x(), max.y()}}, 0.5);
}

}  // namespace

// Two islands of desks with aisles around and between. The robot goes down and up the middle aisle
// and round both islands in both directions; the people's rounds lie beside and across its way.
Scenario make_office() {
  WorldBuilder build;
  add_room(build);
  add_furniture(build);

  Scenario scenario;
  scenario.name = "office";
  scenario.world = build.build();
  scenario.route = Route::closed({{5.0, 6.45},
                                  {5.0, 1.6},
                                  {8.55, 1.6},
                                  {8.55, 6.4},
                                  {1.4, 6.45},
                                  {1.45, 1.55},
                                  {5.05, 1.55},
                                  {5.05, 6.4},
                                  {8.5, 6.45},
                                  {8.6, 1.55},
                                  {1.4, 1.6},
                                  {1.4, 6.4}},
                                 0.9);
  scenario.style.distance_m = 200;
  scenario.style.weave_m = 0.05;
  scenario.walkers = {{rectangle({2.5, 5.65}, {7.5, 7.25}), 0.9},
                      {rectangle({2.6, 0.75}, {7.6, 2.35}), 0.7},
                      {rectangle({0.65, 2.7}, {2.15, 5.2}), 0.6},
                      {rectangle({7.85, 2.9}, {9.3, 5.0}), 0.5},
                      {rectangle({4.3, 0.8}, {9.3, 7.2}), 1.0}};
  return scenario;
}

}  // namespace holdfast::simulation
