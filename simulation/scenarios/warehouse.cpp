#include "simulation/scenarios/all.hpp"
#include "simulation/world/furniture.hpp"

namespace holdfast::simulation {
namespace {

constexpr double kLength = 40;
constexpr double kWidth = 24;
constexpr double kHeight = 8;
constexpr int kRows = 5;
constexpr double kFirstRow = 4.6;  // y of the first row's middle
constexpr double kRowStep = 3.7;   // leaves aisles of 2.6 m
constexpr double kQuarter = 1.5707963267948966;

WallOpening gate(double start) {
  return {start, 3.2, 0, 3.6, 0.25, false, materials::kPaintedMetal};
}

}  // namespace

// Rows of racks that look much alike; the loads differ from place to place.
Scenario make_warehouse() {
  WorldBuilder build;
  build.floor({0, 0}, {kLength, kWidth}, 0, materials::kConcrete);
  build.ceiling({0, 0}, {kLength, kWidth}, kHeight, materials::kPaintedMetal);
  build.wall({{0, 0},
              {kLength, 0},
              0,
              kHeight,
              materials::kConcrete,
              {gate(4), gate(9.5), gate(15), {30, 1, 0, 2.1, 0.15}}});
  build.wall({{kLength, 0}, {kLength, kWidth}, 0, kHeight, materials::kConcrete, {gate(10)}});
  build.wall({{kLength, kWidth},
              {0, kWidth},
              0,
              kHeight,
              materials::kConcrete,
              {{6, 1, 0, 2.1, 0.15}, {27, 1, 0, 2.1, 0.15}}});
  build.wall({{0, kWidth}, {0, 0}, 0, kHeight, materials::kConcrete, {}});
  for (double x = 5; x < kLength; x += 10) {
    for (const double y : {0.2, kWidth - 0.2}) {
      build.box({{x, y, 0.5 * kHeight}, {0.4, 0.4, kHeight}}, materials::kConcrete);
    }
  }
  for (int row = 0; row < kRows; ++row) {
    RackPlan plan;
    plan.variant = static_cast<unsigned>(row);
    add_rack(build, {{20, kFirstRow + row * kRowStep}, kQuarter}, plan);
  }

  build.spare([&] {
    for (const double y : {5.0, 7.5, 16.0, 18.5}) {
      add_crate(build, {{38.9, y}, 0.05 * y}, {1.0, 1.2, 0.6 + 0.06 * y});
    }
    for (const double x : {12.0, 17.4, 25.0}) add_crate(build, {{x, 23.2}, 0}, {1.2, 0.8, 1.6});
  });

  Scenario scenario;
  scenario.name = "warehouse";
  scenario.world = build.build();
  const auto aisle = [](int row) { return kFirstRow + (row + 0.5) * kRowStep; };
  scenario.route = Route::closed({{3.5, 2.2},
                                  {36.5, 2.2},
                                  {36.5, aisle(0)},
                                  {3.5, aisle(0)},
                                  {3.5, aisle(2)},
                                  {36.5, aisle(2)},
                                  {36.5, 21.8},
                                  {2.2, 21.8},
                                  {2.2, 2.2 + 1.4}},
                                 1.2);
  scenario.style.distance_m = 200;
  return scenario;
}

}  // namespace holdfast::simulation
