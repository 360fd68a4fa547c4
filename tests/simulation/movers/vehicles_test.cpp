#include "simulation/movers/vehicles.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "simulation/files/scenario_file.hpp"
#include "tests/simulation/support.hpp"
#include "tests/simulation/tolerances.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::make;
using testing::noise_free;
using testing::position;
using testing::record;

/// A robot that drives round a square, and streets that cross its way and share it.
constexpr const char* kCrossing = R"(
name: crossing
world:
  - floor: {min: [-60, -60], max: [60, 60], material: asphalt}
route:
  radius_m: 2
  corners: [[-12, -12], [12, -12], [12, 12], [-12, 12]]
vehicles:
  - {speed_m_s: 6, route: {radius_m: 5, corners: [[-40, -4], [40, -4], [40, 20], [-40, 20]]}}
  - {speed_m_s: 4, kind: van, route: {radius_m: 5, corners: [[0, -40], [25, -40], [0, 40]]}}
  - {speed_m_s: 5, kind: bus, route: {radius_m: 8, corners: [[-45, 8], [45, 8], [0, 45]]}}
  - {speed_m_s: 3, route: {radius_m: 4, corners: [[-12, -30], [30, -30], [-12, 30]]}}
)";

Scenario crossing() { return *parse_scenario(kCrossing, "crossing.yaml"); }

/// From the outline of a vehicle to a point beside it.
double distance_to(const MotionState& vehicle, const Vector2d& size, const Vector3d& p) {
  const Vector3d beside = vehicle.T_map_body.inverse() * p;
  return (beside.head<2>().cwiseAbs() - 0.5 * size).cwiseMax(0).norm();
}

TEST(Vehicles, NeverComeNearTheRobot) {
  const Scenario scenario = crossing();
  const std::vector<TimeNs> kidnaps = {20 * kSecond, 45 * kSecond};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Drive robot = Drive::plan(scenario.route, scenario.style, seed, 90 * kSecond,
                                    seed > 3 ? kidnaps : std::vector<TimeNs>());
    std::vector<Material> materials;
    const auto planned = drive_vehicles(scenario.vehicles, robot, Walkers(), seed);
    const Movers vehicles(planned, materials);
    EXPECT_GE(vehicles.size(), 3U) << seed;
    for (TimeNs t = 0; t <= robot.duration(); t += kSecond / 20) {
      const Vector3d body = robot.at(t).T_map_body.translation;
      for (std::size_t i = 0; i < vehicles.size(); ++i) {
        const BodyBox& hull = vehicles.boxes(i).front();
        ASSERT_GT(distance_to(vehicles.at(i, t), hull.size.head<2>(), body), 0.95)
            << "vehicle " << i << ", seed " << seed << " at " << to_seconds(t) << " s";
      }
    }
  }
}

TEST(Vehicles, DriveOnAtTheirSpeedWhereNothingIsInTheWay) {
  const Scenario scenario = crossing();
  const Drive robot = Drive::plan(scenario.route, scenario.style, 1, 60 * kSecond, {});
  VehiclePlan far = {Route::closed({{100, 0}, {200, 0}, {200, 80}, {100, 80}}, 10), 8};
  const auto driven = drive_vehicles({far}, robot, Walkers(), 1);
  ASSERT_EQ(driven.size(), 1U);
  double way = 0;
  for (TimeNs t = 10 * kSecond; t < 60 * kSecond; t += kSecond / 10) {
    const double speed = driven[0].path.at(t).v_map.norm();
    EXPECT_LT(speed, 8.01);
    way += 0.1 * speed;
  }
  // Turns of 10 m are taken at sqrt(2 * 10) = 4.5 m/s; they and braking take a fifth of the time.
  EXPECT_GT(way, 0.6 * 8 * 50);
  EXPECT_LT(way, 8.0 * 50);
}

TEST(Vehicles, AreTheSameForASeedAndOthersForAnother) {
  const Scenario scenario = crossing();
  const Drive robot = Drive::plan(scenario.route, scenario.style, 1, 20 * kSecond, {});
  const auto at_ten = [&](std::uint64_t seed) -> Vector3d {
    return drive_vehicles(scenario.vehicles, robot, Walkers(), seed)[0]
        .path.at(10 * kSecond)
        .T_map_body.translation;
  };
  EXPECT_EQ(at_ten(1), at_ten(1));
  EXPECT_GT((at_ten(1) - at_ten(2)).norm(), 0.1);
}

/// A point is explained by the static world or lies on a vehicle as it was at the ray's time.
TEST(Vehicles, AreSeenWhereTheyAreAtTheTimeOfTheRay) {
  Scenario scenario = crossing();
  Scenario empty = crossing();
  empty.vehicles.clear();
  SimulationOptions options = noise_free("", 12);
  options.lidar.keep_all_returns = true;
  const auto seen = std::move(*Simulation::create(std::move(scenario), options));
  const auto bare = std::move(*Simulation::create(std::move(empty), options));
  const auto log = record(*seen);
  const auto without = record(*bare);
  std::size_t on_vehicles = 0;
  for (std::size_t s = 10; s < log.scans.size(); s += 10) {
    const Scan& scan = log.scans[s];
    const auto truth = seen->true_geometry(scan);
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const TimeNs t = scan.stamp + scan.points[i].time_offset_ns;
      const Vector3d p =
          seen->truth_at(t) * (options.lidar.T_body_lidar * position(scan.points[i]));
      // A vehicle of 6 m/s that brakes with up to 10 m/s^2 (smoothed from a decision to the next)
      // is carried on steadily over 1.1 ms: 6 micrometres; the rest is that of floats at 60 m.
      ASSERT_LT(std::abs(truth[i].normal_map.dot(p - truth[i].point_map)), 2e-4)
          << "point " << i << " of scan " << s << (truth[i].moving ? ", moving" : "");
      on_vehicles += truth[i].moving ? 1 : 0;
    }
    EXPECT_GE(scan.points.size(), without.scans[s].points.size());
  }
  EXPECT_GT(on_vehicles, 1000U);
}

TEST(Vehicles, ChangeNoReturnsButTheirOwn) {
  const Scenario scenario = crossing();
  Scenario far = crossing();
  const auto away = Route::closed({{1000, 0}, {1100, 0}, {1100, 80}}, 10);
  far.vehicles = {{away, 5, VehicleKind::kBus}};
  Scenario none = crossing();
  none.vehicles.clear();
  SimulationOptions options;
  options.duration_s = 3;
  const auto a = record(**Simulation::create(std::move(far), options));
  const auto b = record(**Simulation::create(std::move(none), options));
  ASSERT_EQ(a.scans.size(), b.scans.size());
  for (std::size_t s = 0; s < a.scans.size(); ++s) {
    ASSERT_EQ(a.scans[s].points.size(), b.scans[s].points.size());
    for (std::size_t i = 0; i < a.scans[s].points.size(); ++i) {
      ASSERT_EQ(position(a.scans[s].points[i]), position(b.scans[s].points[i]));
    }
  }
}

TEST(Vehicles, InFilesHaveARouteASpeedAndAKind) {
  const Scenario scenario = crossing();
  ASSERT_EQ(scenario.vehicles.size(), 4U);
  EXPECT_EQ(scenario.vehicles[2].kind, VehicleKind::kBus);
  EXPECT_EQ(scenario.vehicles[0].kind, VehicleKind::kCar);
  EXPECT_EQ(scenario.vehicles[1].speed_m_s, 4);
  const auto wrong = parse_scenario(
      "world: []\nroute: {corners: [[0, 0], [9, 0], [9, 9]]}\nvehicles:\n"
      "  - {kind: tram, route: {corners: [[0, 0], [9, 0], [9, 9]]}}\n",
      "street.yaml");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().message, "street.yaml:4: expected car, van or bus, found 'tram'");
}

}  // namespace
}  // namespace holdfast::simulation
