#include <numbers>

#include "simulation/scenarios/all.hpp"
#include "simulation/world/furniture.hpp"

namespace holdfast::simulation {
namespace {

constexpr double kLength = 50;
constexpr double kWidth = 3;
constexpr double kHeight = 2.9;
constexpr double kNorth = 0.5 * std::numbers::pi;   // direction away from the south wall
constexpr double kSouth = -0.5 * std::numbers::pi;  // direction away from the north wall

WallOpening door(double start, double width = 1.0) {
  return {start, width, 0, 2.1, 0.14, false, materials::kWood};
}

WallOpening hydrant_niche(double start) {
  return {start, 0.75, 0.45, 1.3, 0.18, false, materials::kPaintedMetal};
}

void add_pilaster(WorldBuilder& build, double x, bool south) {
  const double y = south ? 0.075 : kWidth - 0.075;
  build.box({{x, y, 0.5 * kHeight}, {0.45, 0.15, kHeight}}, materials::kPlaster);
}

void add_board(WorldBuilder& build, double x, bool south, double width) {
  const Placement place{{x, south ? 0.0 : kWidth}, south ? kNorth : kSouth};
  add_wall_box(build, place, 0.9, {0.03, width, 1.0}, materials::kFabric);
}

void add_cabinet_on_wall(WorldBuilder& build, double x, bool south) {
  const Placement place{{x, south ? 0.0 : kWidth}, south ? kNorth : kSouth};
  add_wall_box(build, place, 0.6, {0.16, 0.5, 0.7}, materials::kPaintedMetal);
}

}  // namespace

// Flat walls and even surfaces (article, figure 4a); doors and pilasters at uneven distances tell
// where along the corridor one is. x runs along it, the south wall is y = 0.
Scenario make_corridor() {
  WorldBuilder build;
  const Material& plaster = materials::kPlaster;
  build.floor({0, 0}, {kLength, kWidth}, 0, materials::kLinoleum);
  build.ceiling({0, 0}, {kLength, kWidth}, kHeight, materials::kCeilingTile);
  build.wall({{0, 0},
              {kLength, 0},
              0,
              kHeight,
              plaster,
              {door(3.1), door(8.4), hydrant_niche(11.6), door(15.2), door(20.9, 1.6), door(27.7),
               door(33.0), hydrant_niche(36.2), door(39.5), door(45.6)}});
  build.wall({{kLength, kWidth},
              {0, kWidth},
              0,
              kHeight,
              plaster,
              {door(2.2), door(7.9), door(12.4, 1.6), hydrant_niche(17.1), door(21.0), door(26.3),
               door(31.1), door(37.7), hydrant_niche(41.0), door(44.8)}});
  build.wall({{kLength, 0},
              {kLength, kWidth},
              0,
              kHeight,
              plaster,
              {{0.8, 1.4, 0.9, 2.2, 0.2, false, materials::kWood}}});
  build.wall({{0, kWidth}, {0, 0}, 0, kHeight, plaster, {door(0.6, 1.8)}});
  for (const double x : {6.5, 13.4, 24.2, 31.0, 43.6}) add_pilaster(build, x, true);
  for (const double x : {3.8, 14.9, 20.8, 34.9, 40.2}) add_pilaster(build, x, false);
  add_board(build, 18.0, true, 1.5);
  add_board(build, 42.0, true, 1.0);
  add_board(build, 9.6, false, 2.0);
  add_board(build, 27.0, false, 1.2);
  add_cabinet_on_wall(build, 30.2, true);
  add_cabinet_on_wall(build, 17.4, false);
  add_cabinet_on_wall(build, 46.4, false);

  build.spare([&] {
    for (const double x : {5.4, 19.6, 25.9, 40.8}) {
      add_crate(build, {{x, 0.19}, 0}, {0.8 + 0.02 * x, 0.34, 0.5 + 0.02 * x});
    }
    for (const double x : {5.6, 18.6, 33.3, 47.5}) {
      add_crate(build, {{x, kWidth - 0.19}, 0}, {0.6, 0.34, 1.5 - 0.02 * x}, materials::kWood);
    }
    add_board(build, 22.9, false, 1.4);
  });

  Scenario scenario;
  scenario.name = "corridor";
  scenario.world = build.build();
  scenario.route = Route::closed({{0.9, 0.95}, {49.1, 0.95}, {49.1, 2.05}, {0.9, 2.05}}, 0.55);
  scenario.style.distance_m = 100;
  return scenario;
}

}  // namespace holdfast::simulation
