#include <gtest/gtest.h>

#include <cmath>

#include "holdfast/io/cloud_file.hpp"
#include "simulation/change/world_change.hpp"
#include "simulation/files/scenario_file.hpp"
#include "simulation/world/survey.hpp"
#include "tests/simulation/support.hpp"
#include "tests/simulation/tolerances.hpp"
#include "tests/simulation/world_files.hpp"

/// A world of discs, driven through, surveyed and judged.
namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using testing::WorldFolder;

const Vector3d kRoom(20, 10, 4);

double wall_distance(const Vector3d& p) {
  return std::min(p.cwiseAbs().minCoeff(), (kRoom - p).cwiseAbs().minCoeff());
}

/// The six faces of a room as a grid of points 10 cm apart.
io::PointCloud room_points() {
  io::PointCloud cloud;
  constexpr double kStep = 0.1;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (double a = 0.5 * kStep; a < kRoom[u]; a += kStep) {
      for (double b = 0.5 * kStep; b < kRoom[v]; b += kStep) {
        for (const double side : {0.0, kRoom[axis]}) {
          Vector3d p;
          p[axis] = side;
          p[u] = a;
          p[v] = b;
          cloud.points.push_back(p.cast<float>());
        }
      }
    }
  }
  return cloud;
}

struct CloudWorld : ::testing::Test {
  WorldFolder folder;

  Scenario room(const std::string& more = "") {
    EXPECT_TRUE(io::write_cloud(folder.path() / "room.pcd", room_points()));
    auto scenario = read_scenario_file(
        folder.scenario("  - cloud: {file: room.pcd, spacing: 0.02, material: ideal}" + more));
    EXPECT_TRUE(scenario) << scenario.error().message;
    return std::move(*scenario);
  }

  std::unique_ptr<Simulation> drive(const SimulationOptions& options) {
    auto simulation = Simulation::create(room(), options);
    EXPECT_TRUE(simulation) << simulation.error().message;
    return std::move(*simulation);
  }
};

/// Centres are floats of up to 20 m moved onto fitted planes: some roundings of 1e-6.
constexpr double kOnWall = 2e-5;

TEST_F(CloudWorld, OfARoomIsTheRoomToItsScans) {
  const auto simulation = drive(testing::noise_free("", 1));
  const auto log = testing::record(*simulation);
  ASSERT_GE(log.scans.size(), 8U);
  const SE3& T_body_lidar = simulation->options().lidar.T_body_lidar;
  for (const Scan& scan : log.scans) {
    std::size_t off = 0;
    for (const ScanPoint& point : scan.points) {
      const SE3 T_map_body = simulation->truth_at(scan.stamp + point.time_offset_ns);
      const Vector3d p = T_map_body * (T_body_lidar * testing::position(point));
      off += wall_distance(p) > tolerances::kRayInRoom + kOnWall ? 1U : 0U;
    }
    // Rims have small discs, between which rays may pass: at most all in the 5 cm beside the edges,
    // 2 * 136 m of them, of 640 m^2.
    EXPECT_GT(scan.points.size(), 28800U * 978 / 1000);
    EXPECT_LT(off, scan.points.size() * 22 / 1000);
  }
}

TEST_F(CloudWorld, KnowsTheNormalBehindEachReturn) {
  const auto simulation = drive(testing::noise_free("", 0.5));
  const auto log = testing::record(*simulation);
  ASSERT_FALSE(log.scans.empty());
  const auto truth = simulation->true_geometry(log.scans[0]);
  ASSERT_EQ(truth.size(), log.scans[0].points.size());
  std::size_t skew = 0;
  for (const TrueReturn& point : truth) {
    EXPECT_EQ(point.edge_distance_m, TrueGeometry::kReach);
    EXPECT_NEAR(point.normal_map.norm(), 1, 1e-6);
    skew += point.normal_map.cwiseAbs().maxCoeff() < 0.999 ? 1U : 0U;
  }
  EXPECT_LT(skew, truth.size() / 100);
}

TEST_F(CloudWorld, IsSurveyedAtItsPointsWithTheSurveysNoise) {
  const Scenario scenario = room();
  const RayCaster caster(scenario.world);
  WorkerPool one(1), two(2);
  const auto map = survey(scenario.world, caster, scenario.route, SurveyModel{}, 1, one);
  EXPECT_EQ(map.points,
            survey(scenario.world, caster, scenario.route, SurveyModel{}, 1, two).points);
  const double n = static_cast<double>(map.points.size());
  EXPECT_GT(n, 0.98 * static_cast<double>(scenario.world.discs.size()));
  double squares = 0, counted = 0;
  for (const Vector3f& p : map.points) {
    if (p.z() > 2 || p.x() < 1 || p.y() < 1 || p.x() > 19 || p.y() > 9) continue;
    squares += p.z() * p.z();
    ++counted;
  }
  EXPECT_NEAR(squares / counted / (0.005 * 0.005), 1, tolerances::variance_error(counted));
}

TEST_F(CloudWorld, StaysAsItIsWhenObjectsChange) {
  const Scenario scenario = room("\n  - crate: {at: [10, 5]}\n  - crate: {at: [5, 5]}");
  const auto changed = change_world(scenario, 1, 1);
  ASSERT_TRUE(changed) << changed.error().message;
  EXPECT_EQ(changed->before.discs.size(), scenario.world.discs.size());
  EXPECT_EQ(changed->after.discs.size(), scenario.world.discs.size());
}

TEST_F(CloudWorld, TrianglesAndDiscsHideEachOther) {
  const Scenario scenario =
      room("\n  - box: {center: [10, 5, 1], size: [2, 2, 2], material: wood}");
  const RayCaster caster(scenario.world);
  const auto onto_box = testing::cast_one(caster, {1, 5.02, 1}, {1, 0, 0});
  EXPECT_NEAR(onto_box.range[0], 8, 1e-5);
  EXPECT_STREQ(scenario.world.materials[onto_box.material[0]].name, "wood");
  EXPECT_LT(onto_box.triangle[0], scenario.world.triangles.size());
  const auto onto_wall = testing::cast_one(caster, {1, 5.02, 3}, {1, 0, 0});
  EXPECT_NEAR(onto_wall.range[0], 19, kOnWall);
  EXPECT_STREQ(scenario.world.materials[onto_wall.material[0]].name, "ideal");
  EXPECT_GE(onto_wall.triangle[0], scenario.world.triangles.size());
}

}  // namespace
}  // namespace holdfast::simulation
