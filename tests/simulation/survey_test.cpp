#include "simulation/world/survey.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/scenario.hpp"
#include "simulation/world/world_builder.hpp"
#include "tests/simulation/tolerances.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

const Vector3d kRoom(12, 8, 4);

io::PointCloud survey_of(const World& world, const Route& route, std::uint64_t seed = 1,
                         int threads = 1) {
  const RayCaster caster(world);
  WorkerPool pool(threads);
  return survey(world, caster, route, SurveyModel{}, seed, pool);
}

Scenario box() { return *make_scenario("box"); }

/// Axis and signed offset of the wall of the box world nearest to `p`.
std::pair<int, double> nearest_wall(const Vector3d& p) {
  std::pair<int, double> best{0, 1e9};
  for (int k = 0; k < 3; ++k) {
    for (const double offset : {p[k], p[k] - kRoom[k]}) {
      if (std::abs(offset) < std::abs(best.second)) best = {k, offset};
    }
  }
  return best;
}

TEST(Survey, LeavesFiveMillimetresOfNoise) {
  double sum = 0;
  double squares = 0;
  double n = 0;
  for (const Vector3f& point : survey_of(box().world, box().route).points) {
    const Vector3d p = point.cast<double>();
    const auto [axis, offset] = nearest_wall(p);
    const Vector3d inside = p.cwiseMin(kRoom - p);
    // Near an edge of the room the nearest wall need not be the point's own.
    if ((inside.array() < 0.03).count() > 1) continue;
    sum += offset;
    squares += offset * offset;
    ++n;
  }
  EXPECT_NEAR(sum / n, 0, tolerances::mean_error(0.005, n));
  EXPECT_NEAR(squares / n / (0.005 * 0.005), 1, tolerances::variance_error(n));
}

// One point in each square of 6 cm: the density follows exactly but for the squares cut by edges.
TEST(Survey, PutsOnePointInEachSquareOfSixCentimetres) {
  const auto cloud = survey_of(box().world, box().route);
  const double area = 2 * (12 * 8 + 12 * 4 + 8 * 4);
  const double squares = area / (0.06 * 0.06);
  // 80 m of edges cut about 1333 squares, whose points fall in or out by chance.
  EXPECT_NEAR(static_cast<double>(cloud.points.size()), squares, 5 * std::sqrt(2.0 * 80 / 0.06));

  std::vector<Vector3f> floor;
  for (const Vector3f& p : cloud.points) {
    if (p.z() < 0.03F && p.x() > 4 && p.x() < 6 && p.y() > 3 && p.y() < 5) floor.push_back(p);
  }
  std::vector<float> nearest;
  for (const Vector3f& p : floor) {
    float best = std::numeric_limits<float>::infinity();
    for (const Vector3f& q : floor) {
      if (&p != &q) best = std::min(best, (p - q).norm());
    }
    nearest.push_back(best);
  }
  std::sort(nearest.begin(), nearest.end());
  EXPECT_GT(nearest.front(), 0.015);  // squares leave 3 cm between points, noise takes some
  EXPECT_GT(nearest[nearest.size() / 2], 0.04);
  EXPECT_LT(nearest.back(), 0.09);
}

TEST(Survey, HoldsOnlyWhatCanBeSeenFromTheRoute) {
  WorldBuilder build;
  build.floor({0, 0}, {12, 8}, 0, materials::kIdeal);
  const Box cabinet{{6, 4, 0.5}, {1, 1, 1}};      // stands on the floor, higher than the LiDAR
  const Box shelf{{2, 7.6, 1.0}, {1, 0.4, 0.1}};  // its underside is above the LiDAR
  build.box(cabinet, materials::kWood);
  build.box(shelf, materials::kWood);
  const auto cloud = survey_of(build.build(), box().route);
  std::size_t beside = 0;
  std::size_t under_shelf = 0;
  for (const Vector3f& point : cloud.points) {
    const Vector3d p = point.cast<double>() - Vector3d(6, 4, 0);
    const bool over = std::abs(p.x()) < 0.47 && std::abs(p.y()) < 0.47;
    EXPECT_FALSE(over) << "inside, below or on top of the cabinet: " << point.transpose();
    if (std::abs(p.x()) < 0.53 && std::abs(p.y()) < 0.53 && p.z() > 0.1) ++beside;
    if (std::abs(point.x() - 2) < 0.4 && std::abs(point.z() - 0.95) < 0.02) ++under_shelf;
    const bool on_shelf = std::abs(point.x() - 2) < 0.4 && point.y() > 7.43 && point.z() > 1.03;
    EXPECT_FALSE(on_shelf) << point.transpose();
  }
  EXPECT_GT(beside, 0.9 * 4 * 0.9 / 0.0036);
  EXPECT_GT(under_shelf, 50U);
}

TEST(Survey, DropsMostOfTheGlassAndKeepsItsFrames) {
  const auto points_on = [](const Material& material) {
    WorldBuilder build;
    build.wall({{0, 0}, {12, 0}, 0, 3, material, {}});
    return static_cast<double>(survey_of(build.build(), box().route).points.size());
  };
  EXPECT_GT(points_on(materials::kAluminium), 0.95 * 36 / 0.0036);
  EXPECT_LT(points_on(materials::kGlass), 0.06 * 36 / 0.0036);
}

TEST(Survey, IsTheSameForAnyNumberOfThreadsAndAnotherForEachSeed) {
  const Scenario office = *make_scenario("office");
  const auto one = survey_of(office.world, office.route, 1, 1);
  const auto two = survey_of(office.world, office.route, 1, 2);
  const auto other = survey_of(office.world, office.route, 2, 2);
  EXPECT_EQ(one.points, two.points);
  EXPECT_NE(one.points, other.points);
}

}  // namespace
}  // namespace holdfast::simulation
