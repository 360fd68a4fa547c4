#include <gtest/gtest.h>

#include <cmath>

#include "simulation/motion/drive.hpp"
#include "simulation/scenario.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

constexpr TimeNs kStep = kSecond / 100;

Drive handheld(const char* name, std::uint64_t seed) {
  const Scenario scenario = *make_scenario(name);
  return Drive::plan(scenario.route, scenario.style.in_hand(), seed, 60 * kSecond, {});
}

TEST(Handheld, ReachesThreeMetresAndThreeRadiansASecondAboutAllAxes) {
  double fastest = 0;
  Vector3d quickest = Vector3d::Zero();
  double tilt = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Drive d = handheld("corridor", seed);
    for (TimeNs t = 0; t < d.duration(); t += kStep) {
      const MotionState state = d.at(t);
      fastest = std::max(fastest, state.v_map.norm());
      quickest = quickest.cwiseMax(state.omega_body.cwiseAbs());
      const Vector3d up = state.T_map_body.rotation.conjugate() * Vector3d::UnitZ();
      tilt = std::max(tilt, std::acos(std::min(1.0, up.z())));
    }
  }
  // 2 m/s +- half of it; the sway of steps adds 2 cm * 2 pi 1.1 Hz across it.
  EXPECT_GT(fastest, 2.5);
  EXPECT_LT(fastest, 3.2);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GT(quickest[axis], 2.5) << axis;
    // A gesture of 3 rad/s, the wobble's 0.03 * pi * (1.7 + 3) and up to 1.5 rad/s of bends.
    EXPECT_LT(quickest[axis], 4.9) << axis;
  }
  EXPECT_GT(tilt, 0.3);
  EXPECT_LT(tilt, 0.5) << "0.4 of a gesture, 0.03 of wobble: far from 90 degrees";
}

TEST(Handheld, HeavesAndSwaysWithItsSteps) {
  const Scenario scenario = *make_scenario("corridor");
  DriveStyle still = scenario.style.in_hand();
  still.step_heave_m = still.step_sway_m = 0;
  const Drive walked = handheld("corridor", 4);
  const Drive glided = Drive::plan(scenario.route, still, 4, 60 * kSecond, {});
  double heave = 0;
  double sway = 0;
  int rises = 0;
  double last = 0;
  for (TimeNs t = 5 * kSecond; t < 55 * kSecond; t += kStep) {
    const Vector3d step = walked.at(t).T_map_body.translation - glided.at(t).T_map_body.translation;
    heave = std::max(heave, std::abs(step.z()));
    sway = std::max(sway, step.head<2>().norm());
    rises += last < 0 && step.z() >= 0 ? 1 : 0;
    last = step.z();
  }
  // A spline through a wave of 2.2 Hz keeps sinc(2.2 / 20)^6 = 0.89 of it.
  EXPECT_GT(heave, 0.88 * 0.02);
  EXPECT_LE(heave, 0.02);
  EXPECT_GT(sway, 0.95 * 0.02);
  EXPECT_LE(sway, 0.02);
  EXPECT_NEAR(rises / 50.0, 2.0, 0.23);
}

TEST(Handheld, RestsAtFirst) {
  const Drive d = handheld("office", 3);
  for (TimeNs t = 0; t <= 2 * kSecond; t += kStep) {
    ASSERT_NEAR(d.at(t).v_map.norm(), 0, 1e-9);
    ASSERT_NEAR(d.at(t).omega_body.norm(), 0, 1e-9);
  }
}

TEST(TurnOnSpot, StandsWhileItTurnsAndGoesStraightOtherwise) {
  const Scenario scenario = *make_scenario("offices");
  DriveStyle style = scenario.style;
  style.turn_on_spot = true;
  style.sway_rad = style.heave_m = 0;
  double turned = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Drive d = Drive::plan(scenario.route, style, seed, 90 * kSecond, {});
    double fastest = 0;
    for (TimeNs t = 0; t < d.duration(); t += kStep) {
      const MotionState state = d.at(t);
      const double rate = std::abs(state.omega_body.z());
      fastest = std::max(fastest, state.v_map.norm());
      ASSERT_LT(rate, 1.1 * 1.1 * style.yaw_rate_rad_s) << "the pace adds a tenth";
      if (rate < 0.05) continue;
      ASSERT_LT(state.v_map.norm(), 0.01) << seed << " " << to_seconds(t);
      turned += rate * to_seconds(kStep);
    }
    EXPECT_GT(fastest, style.speed_m_s);
  }
  EXPECT_GT(turned, 3 * 3.14) << "three drives with some corners each";
}

}  // namespace
}  // namespace holdfast::simulation
