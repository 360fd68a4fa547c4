#include <numbers>

#include "simulation/scenarios/all.hpp"
#include "simulation/world/furniture.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kQuarter = 0.5 * std::numbers::pi;

/// A row of windows over each floor of a facade, from `begin` to `end` along it.
std::vector<WallOpening> windows(double begin, double end, double step) {
  std::vector<WallOpening> out;
  for (double at = begin; at + 1.4 <= end; at += step) {
    out.push_back({at, 1.4, 0.9, 2.4, 0.22, false, materials::kGlass});
  }
  return out;
}

/// A block-shaped house; its facades look outwards.
void add_house(WorldBuilder& build, const Vector2d& min, const Vector2d& max, double height,
               double window_step) {
  const Vector2d corners[] = {min, {min.x(), max.y()}, max, {max.x(), min.y()}};
  for (int i = 0; i < 4; ++i) {
    const Vector2d& from = corners[i];
    const Vector2d& to = corners[(i + 1) % 4];
    const double length = (to - from).norm();
    auto openings = windows(1.2 + 0.3 * i, length - 1, window_step + 0.17 * i);
    build.wall({from, to, 0, 3.2, materials::kBrick, openings});
    openings = windows(1.2 + 0.3 * i, length - 1, window_step + 0.17 * i);
    for (WallOpening& window : openings) {
      window.bottom += 3.2;
      window.top += 3.2;
    }
    build.wall({from, to, 3.2, height, materials::kBrick, openings});
  }
  build.floor(min, max, height, materials::kConcrete);
}

void add_green(WorldBuilder& build) {
  int shape = 0;
  for (const Vector2d& at :
       {Vector2d(24, 22), Vector2d(33, 26), Vector2d(41, 21), Vector2d(52, 27), Vector2d(57, 20),
        Vector2d(27, 38), Vector2d(38, 36), Vector2d(47, 40), Vector2d(56, 35), Vector2d(20, 31),
        Vector2d(7, 18), Vector2d(6, 44), Vector2d(73, 26), Vector2d(74, 46), Vector2d(44, 52)}) {
    add_tree(build, at, 6.5 + 0.9 * (shape % 5), shape);
    ++shape;
  }
  build.box({{30, 17.3, 0.6}, {14, 0.8, 1.2}}, materials::kFoliage);
  build.box({{63.0, 31.5, 0.5}, {0.7, 9, 1.0}}, materials::kFoliage);
  build.box({{40, 30.5, 0.25}, {2.4, 2.4, 0.5}}, materials::kConcrete);
  build.cylinder({40, 30.5, 0.5}, 0.5, 2.2, materials::kConcrete, 24);
}

}  // namespace

// A court between houses: trees, hedges, lamp posts, a few parked cars, open sky.
Scenario make_yard() {
  WorldBuilder build;
  build.floor({0, 0}, {80, 60}, 0, materials::kAsphalt);
  add_house(build, {2, -8}, {34, 4}, 9, 3.1);
  add_house(build, {44, -6}, {79, 5}, 7, 2.6);
  add_house(build, {-7, 8}, {1, 36}, 8, 3.4);
  add_house(build, {10, 55}, {39, 64}, 9.5, 2.9);
  add_house(build, {50, 56}, {77, 66}, 6.8, 3.6);
  add_house(build, {78, 12}, {86, 40}, 7.5, 3.0);
  add_green(build);
  for (const double x : {12.0, 29.0, 48.0, 66.0}) add_pole(build, {{x, 14.6}, kQuarter}, 5);
  for (const double x : {15.0, 35.5, 61.0}) add_pole(build, {{x, 46.5}, -kQuarter}, 5);
  for (const double x : {8.0, 10.9, 16.6, 25.2}) add_car(build, {{x, 7.2}, kQuarter});
  for (const double y : {19.0, 24.8, 27.6}) add_car(build, {{74.5, y}, std::numbers::pi});
  add_car(build, {{58.0, 52.6}, 0.05});

  build.spare([&] {
    for (const double x : {13.8, 19.4, 28.1}) add_car(build, {{x, 7.3}, kQuarter});
    for (const double y : {22.0, 33.5}) add_car(build, {{74.6, y}, std::numbers::pi});
    add_crate(build, {{31, 52.6}, 0.1}, {6.0, 2.4, 2.5}, materials::kPaintedMetal);
    add_crate(build, {{47, 8.0}, 0}, {2.4, 1.6, 2.2}, materials::kFabric);
    for (const double x : {36.0, 44.5}) add_bench(build, {{x, 31.0}, 0}, 2.0);
  });

  Scenario scenario;
  scenario.name = "yard";
  scenario.world = build.build();
  scenario.route = Route::closed({{9, 12},
                                  {69, 11.5},
                                  {69.5, 30},
                                  {62, 44},
                                  {68, 49.5},
                                  {40, 48.5},
                                  {12, 50},
                                  {11, 34},
                                  {16, 24}},
                                 3.0);
  scenario.style.distance_m = 250;
  scenario.style.speed_m_s = 1.5;
  scenario.style.sway_rad = 0.006;
  scenario.style.heave_m = 0.004;
  scenario.walkers = {{Route::closed({{20, 16}, {60, 16.5}, {60, 18}, {20, 18}}, 0.7), 1.0},
                      {Route::closed({{30, 44}, {52, 43}, {52, 46}, {30, 46}}, 1.0), 0.9}};
  return scenario;
}

}  // namespace holdfast::simulation
