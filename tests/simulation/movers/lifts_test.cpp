#include "simulation/movers/lifts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/simulation/support.hpp"
#include "tests/simulation/tolerances.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;
using testing::make;
using testing::noise_free;
using testing::position;
using testing::record;

Drive lift_drive(const Scenario& scenario, std::uint64_t seed,
                 const std::vector<TimeNs>& kidnaps = {}) {
  return Drive::plan(scenario.route, scenario.style, seed, 300 * kSecond, kidnaps);
}

TEST(Ride, RisesToItsHeightWithinItsLimits) {
  for (const double rise : {4.0, -4.0, 0.5, 12.0}) {
    EXPECT_EQ(ride_height(rise, kRideWait), 0);
    EXPECT_DOUBLE_EQ(ride_height(rise, ride_arrival(rise)), rise);
    EXPECT_DOUBLE_EQ(ride_height(rise, ride_end(rise)), rise);
    constexpr double kStep = 1e-3;
    for (double t = 0; t < ride_end(rise); t += kStep) {
      const double h0 = ride_height(rise, t);
      const double h1 = ride_height(rise, t + kStep);
      const double h2 = ride_height(rise, t + 2 * kStep);
      ASSERT_GE((h1 - h0) * rise, 0) << "never back";
      ASSERT_LT(std::abs(h1 - h0) / kStep, kRideSpeed + 1e-9);
      ASSERT_LT(std::abs(h2 - 2 * h1 + h0) / (kStep * kStep), kRideAcceleration + 1e-6);
    }
  }
}

TEST(Ride, TakesTheRobotStraightUpAndDownAsTheRouteSays) {
  const Scenario scenario = *make_scenario("lift");
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Drive drive = lift_drive(scenario, seed);
    ASSERT_GE(drive.rides().size(), 2U) << seed;
    for (const Ride& ride : drive.rides()) {
      EXPECT_NEAR(std::abs(ride.rise_m), 4, 1e-9);
      const TimeNs end = ride.begin + from_seconds(ride_end(ride.rise_m));
      if (end > drive.duration()) continue;
      // Within the middle of the waiting times: smoothing reaches 0.6 s to each side.
      const Vector3d low = drive.at(ride.begin + 2 * kSecond).T_map_body.translation;
      const Vector3d high = drive.at(end - 2 * kSecond).T_map_body.translation;
      EXPECT_NEAR((high - low - Vector3d(0, 0, ride.rise_m)).norm(), 0, 1e-9);
    }
  }
}

TEST(Ride, IsSmoothAndNothingElseLiftsTheRobot) {
  const Scenario scenario = *make_scenario("lift");
  const Drive drive = lift_drive(scenario, 1, {130 * kSecond});
  double fastest = 0;
  for (TimeNs t = 0; t < drive.duration(); t += kSecond / 100) {
    const MotionState state = drive.at(t);
    fastest = std::max(fastest, std::abs(state.v_map.z()));
    // Heaving with 2 mm at up to 2.5 Hz adds 0.5 m/s^2 while the robot drives.
    ASSERT_LT(std::abs(state.a_map.z()), 0.65) << to_seconds(t);
    const double above = state.T_map_body.translation.z() - scenario.style.body_height_m;
    ASSERT_GT(above, -0.01) << to_seconds(t);
    ASSERT_LT(above, 4.01) << to_seconds(t);
  }
  EXPECT_NEAR(fastest, kRideSpeed, 0.02);
}

TEST(Lift, MovesExactlyAsTheRobotInItDoes) {
  const Scenario scenario = *make_scenario("lift");
  const Drive drive = lift_drive(scenario, 2);
  const auto movers = run_lifts(scenario.lifts, drive);
  for (const Ride& ride : drive.rides()) {
    const TimeNs end = ride.begin + from_seconds(ride_end(ride.rise_m)) - kSecond;
    for (TimeNs t = ride.begin + kSecond; t < std::min(end, drive.duration()); t += kSecond / 50) {
      const MotionState robot = drive.at(t);
      const MotionState cabin = movers.front().path.at(t);
      ASSERT_NEAR(robot.T_map_body.translation.z() - scenario.style.body_height_m,
                  cabin.T_map_body.translation.z(), 1e-9);
      ASSERT_NEAR(robot.a_map.z(), cabin.a_map.z(), 1e-7);
    }
  }
}

TEST(Lift, NeverTouchesTheRobot) {
  const Scenario scenario = *make_scenario("lift");
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const bool kidnapped = seed > 3;
    const Drive drive = lift_drive(
        scenario, seed,
        kidnapped ? std::vector<TimeNs>{40 * kSecond, 95 * kSecond} : std::vector<TimeNs>());
    const auto movers = run_lifts(scenario.lifts, drive);
    for (TimeNs t = 0; t < drive.duration(); t += kSecond / 10) {
      const Vector3d body = drive.at(t).T_map_body.translation;
      for (const Mover& mover : movers) {
        const Vector3d p = mover.path.at(t).T_map_body.inverse() * body;
        for (const BodyBox& box : mover.boxes) {
          const double away = ((p - box.center).cwiseAbs() - 0.5 * box.size).cwiseMax(0).norm();
          ASSERT_GT(away, 0.3) << "seed " << seed << " at " << to_seconds(t) << " s";
        }
      }
    }
  }
}

// Boxes are carried on steadily for up to half of 40 columns of 1800, here 11 ms, while the cabin
// speeds up with 0.6 m/s^2: 37 micrometres of height, beside the 10 by which it may not follow the
// robot. A ray that meets floor or ceiling at 14 degrees (beams of 15, the LiDAR tilted by 1) turns
// them into more. Of two scans, one may be of speeding up, one of braking.
constexpr double kCarriedOn = 0.5 * 0.6 * 0.0111 * 0.0111;
constexpr double kFollows = 1e-5;
const double kSeen = 2 * ((kCarriedOn + kFollows) / std::sin(14 * M_PI / 180) + 1e-6);

TEST(Lift, ShowsTheLidarTheSameCabinAllTheWay) {
  SimulationOptions options = noise_free("lift", 200);
  options.lidar.keep_all_returns = true;
  options.lidar.period = kSecond;
  options.seed = 2;
  const auto simulation = make(options);
  const Drive drive =
      Drive::plan(simulation->scenario().route, simulation->scenario().style, 2, 200 * kSecond, {});
  ASSERT_FALSE(drive.rides().empty());
  const Ride ride = drive.rides().front();
  const TimeNs start = simulation->start_time();
  const TimeNs closed = start + ride.begin + from_seconds(3.5);
  const TimeNs arrived = start + ride.begin + from_seconds(ride_arrival(ride.rise_m));
  std::vector<Scan> scans;
  for (Scan& scan : record(*simulation).scans) {
    if (scan.stamp > closed && scan.end_time < arrived) scans.push_back(std::move(scan));
  }
  ASSERT_GE(scans.size(), 4U);
  for (const Scan& scan : scans) {
    ASSERT_EQ(scan.points.size(), scans[0].points.size());
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Vector3d off = position(scan.points[i]) - position(scans[0].points[i]);
      ASSERT_LT(off.norm(), kSeen) << "point " << i;
    }
  }
}

TEST(Lift, IsAClosedDoorToASurveyor) {
  SimulationOptions options = noise_free("lift", 1);
  options.map_sigma_m = 0;
  const auto map = make(options)->survey_map();
  std::size_t on_doors = 0;
  for (const auto& p : map.points) {
    const bool within_doorway = std::abs(p.y() - 9) < 0.55;
    const double beside = std::abs(p.x() - 20);
    if (!within_doorway || beside > 1.56) continue;
    EXPECT_NEAR(beside, 1.3 + kLandingGap + 0.025, 1e-4) << "no cabin, nothing of the shaft";
    ++on_doors;
  }
  // Four doors of 1.1 x 2.1 m, a point on 6 x 6 cm each.
  EXPECT_NEAR(static_cast<double>(on_doors), 4 * 1.1 * 2.1 / 0.0036, 200);
}

}  // namespace
}  // namespace holdfast::simulation
