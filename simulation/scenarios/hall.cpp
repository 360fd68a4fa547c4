#include <cmath>

#include "simulation/scenarios/all.hpp"
#include "simulation/world/furniture.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLength = 20;
constexpr double kWidth = 15;
constexpr double kHeight = 6;

/// A glass front with mullions about every 3 m, a sill rail and a rail at 2.4 m.
void add_glass_front(WorldBuilder& build, const Vector2d& from, const Vector2d& to, int panes) {
  build.wall({from, to, 0, kHeight, materials::kGlass, {}});
  const Vector2d along = (to - from).normalized();
  const Vector2d inwards(-along.y(), along.x());
  const double yaw = std::atan2(along.y(), along.x());
  const double length = (to - from).norm();
  for (int i = 0; i <= panes; ++i) {
    const Vector2d at = from + along * (length * i / panes) + 0.05 * inwards;
    const Vector3d center(at.x(), at.y(), 0.5 * kHeight);
    build.box({center, {0.05, 0.08, kHeight}, yaw}, materials::kAluminium);
  }
  const Vector2d middle = 0.5 * (from + to) + 0.03 * inwards;
  build.box({{middle.x(), middle.y(), 0.04}, {length, 0.06, 0.08}, yaw}, materials::kAluminium);
  build.box({{middle.x(), middle.y(), 2.4}, {length, 0.05, 0.05}, yaw}, materials::kAluminium);
}

}  // namespace

// A lobby that gives a LiDAR little: glass on all sides, a polished floor, a ceiling out of reach.
// Columns and the frames of the glass are what there is (article, figure 4b).
Scenario make_hall() {
  WorldBuilder build;
  build.floor({0, 0}, {kLength, kWidth}, 0, materials::kPolishedStone);
  build.ceiling({0, 0}, {kLength, kWidth}, kHeight, materials::kPlaster);
  add_glass_front(build, {0, 0}, {kLength, 0}, 7);
  add_glass_front(build, {kLength, 0}, {kLength, kWidth}, 5);
  add_glass_front(build, {kLength, kWidth}, {0, kWidth}, 6);
  add_glass_front(build, {0, kWidth}, {0, 0}, 4);
  for (const Vector2d& at :
       {Vector2d(5.2, 4.4), Vector2d(5.0, 10.6), Vector2d(14.6, 4.8), Vector2d(15.1, 10.4)}) {
    build.cylinder({at.x(), at.y(), 0}, 0.23, kHeight, materials::kConcrete, 64);
  }

  build.spare([&] {
    for (const double y : {6.0, 9.2}) add_bench(build, {{0.7, y}, 0}, 1.8);
    add_bench(build, {{19.2, 7.0}, 0}, 2.0);
    for (const double x : {8.0, 13.5}) add_plant(build, {x, 14.3});
    add_plant(build, {7.0, 0.7});
    add_crate(build, {{14.2, 7.9}, 0.4}, {1.6, 0.6, 1.1}, materials::kWood);
    add_partition(build, {{5.6, 4.9}, 0.8}, 1.2, 1.9);
  });

  Scenario scenario;
  scenario.name = "hall";
  scenario.world = build.build();
  scenario.route = Route::closed(
      {{2.6, 2.4}, {10.0, 2.9}, {17.4, 2.3}, {17.6, 12.4}, {10.2, 11.8}, {9.6, 7.6}, {2.6, 7.4}},
      1.5);
  scenario.style.distance_m = 150;
  return scenario;
}

}  // namespace holdfast::simulation
