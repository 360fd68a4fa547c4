#include "simulation/motion/drive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulation/scenario.hpp"
#include "tests/tolerances.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

Drive drive(const char* name, std::uint64_t seed, const std::vector<TimeNs>& kidnaps = {}) {
  const Scenario scenario = *make_scenario(name);
  return Drive::plan(scenario.route, scenario.style, seed, std::nullopt, kidnaps);
}

double way(const Drive& drive) {
  double length = 0;
  constexpr TimeNs kStep = kSecond / 100;
  for (TimeNs t = 0; t < drive.duration(); t += kStep) {
    length += drive.at(t).v_map.norm() * to_seconds(kStep);
  }
  return length;
}

TEST(Drive, RestsForTwoSecondsThenGoes) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Drive d = drive("corridor", seed);
    for (TimeNs t = 0; t <= 2 * kSecond; t += kSecond / 50) {
      const MotionState state = d.at(t);
      // Equal control values leave rounding only: 1e-15 of 50 m, divided by the knot once and
      // twice.
      ASSERT_NEAR(state.v_map.norm(), 0, 1e-11);
      ASSERT_NEAR(state.a_map.norm(), 0, 1e-9);
      ASSERT_NEAR(state.omega_body.norm(), 0, 1e-11);
    }
    EXPECT_GT(d.at(6 * kSecond).v_map.norm(), 0.5);
    EXPECT_NEAR(d.at(d.duration()).v_map.norm(), 0, 1e-9) << "and rests at the end";
  }
}

TEST(Drive, GoesTheDistanceAtItsSpeed) {
  for (const char* name : {"corridor", "office", "hall"}) {
    const Scenario scenario = *make_scenario(name);
    const Drive d = drive(name, 2);
    // Weaving lengthens the way and smoothing cuts corners, both by less than 1 %.
    EXPECT_NEAR(way(d), scenario.style.distance_m, 0.01 * scenario.style.distance_m) << name;
    double fastest = 0;
    double quickest_turn = 0;
    for (TimeNs t = 0; t < d.duration(); t += kSecond / 50) {
      const MotionState state = d.at(t);
      fastest = std::max(fastest, state.v_map.norm());
      quickest_turn = std::max(quickest_turn, std::abs(state.omega_body.z()));
    }
    // 10 % by the pace, 5 % by weaving across the speed limit's turns.
    EXPECT_LT(fastest, 1.15 * scenario.style.speed_m_s) << name;
    EXPECT_GT(fastest, scenario.style.speed_m_s) << name;
    EXPECT_LT(quickest_turn, 1.25 * scenario.style.yaw_rate_rad_s) << name;
  }
}

TEST(Drive, IsAnotherForEachSeedAndTheSameForOne) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SE3 a = drive("hall", seed).at(20 * kSecond).T_map_body;
    const SE3 again = drive("hall", seed).at(20 * kSecond).T_map_body;
    EXPECT_EQ(a.translation, again.translation);
    EXPECT_EQ(a.rotation.coeffs(), again.rotation.coeffs());
    for (std::uint64_t other = 1; other < seed; ++other) {
      const SE3 b = drive("hall", other).at(20 * kSecond).T_map_body;
      EXPECT_GT((a.translation - b.translation).norm(), 1e-3) << seed << " and " << other;
    }
  }
}

TEST(Drive, SwaysWithinItsAmplitudes) {
  const Scenario scenario = *make_scenario("corridor");
  const Drive d = drive("corridor", 4);
  double sway = 0;
  double heave = 0;
  for (TimeNs t = 0; t < d.duration(); t += kSecond / 50) {
    const SE3 pose = d.at(t).T_map_body;
    const Vector3d up = pose.rotation.conjugate() * Vector3d::UnitZ();
    sway = std::max(sway, std::acos(std::min(1.0, up.z())));
    heave = std::max(heave, std::abs(pose.translation.z() - scenario.style.body_height_m));
  }
  // Roll and pitch together reach sqrt(2) amplitudes, 10 % more at the fastest pace.
  EXPECT_LT(sway, 1.1 * std::sqrt(2.0) * scenario.style.sway_rad);
  EXPECT_GT(sway, 0.3 * scenario.style.sway_rad);
  EXPECT_LT(heave, 1.1 * scenario.style.heave_m);
  EXPECT_GT(heave, 0.3 * scenario.style.heave_m);
}

TEST(Drive, WobblesWithItsAmplitudeAtOneToThreeHertzOnceItMoves) {
  const Scenario scenario = *make_scenario("corridor");
  DriveStyle style = scenario.style;
  style.wobble_rad = 0.08;
  const Drive calm = Drive::plan(scenario.route, scenario.style, 4, 40 * kSecond, {});
  const Drive wild = Drive::plan(scenario.route, style, 4, 40 * kSecond, {});
  Vector3d most = Vector3d::Zero();
  int crossings = 0;
  double last_pitch = 0;
  constexpr TimeNs kStep = kSecond / 100;
  for (TimeNs t = 0; t < 40 * kSecond; t += kStep) {
    const SE3 a = calm.at(t).T_map_body;
    const SE3 b = wild.at(t).T_map_body;
    const Vector3d turn = so3::log(a.rotation.conjugate() * b.rotation);
    ASSERT_LT((a.translation - b.translation).norm(), 1e-12) << "it turns about the body";
    if (t <= 2 * kSecond) {
      ASSERT_LT(turn.norm(), 1e-12) << "at rest";
    }
    if (t < 5 * kSecond) continue;
    most = most.cwiseMax(turn.cwiseAbs());
    crossings += turn.y() * last_pitch < 0 ? 1 : 0;
    last_pitch = turn.y();
  }
  for (int k = 0; k < 3; ++k) {
    // Roll, pitch and yaw mix by the product of two of them (0.08^2 / 2).
    EXPECT_LT(most[k], 0.08 + 0.004);
    EXPECT_GT(most[k], 0.9 * 0.08) << "two waves of half the amplitude meet in 35 s";
  }
  const double frequency = crossings / 2.0 / 35;
  EXPECT_GT(frequency, 0.9);
  EXPECT_LT(frequency, 3.1);
}

TEST(Drive, GoesFasterByItsFactor) {
  const Scenario scenario = *make_scenario("corridor");
  const DriveStyle style = scenario.style.faster(2);
  const Drive slow = Drive::plan(scenario.route, scenario.style, 2, 40 * kSecond, {});
  const Drive fast = Drive::plan(scenario.route, style, 2, 40 * kSecond, {});
  double most_slow = 0;
  double most_fast = 0;
  for (TimeNs t = 0; t < 40 * kSecond; t += kSecond / 50) {
    most_slow = std::max(most_slow, slow.at(t).v_map.norm());
    most_fast = std::max(most_fast, fast.at(t).v_map.norm());
    ASSERT_LT(std::abs(fast.at(t).omega_body.z()), 1.25 * style.yaw_rate_rad_s);
  }
  EXPECT_NEAR(most_fast / most_slow, 2, 0.2);
}

/// Kidnaps every 7 s, so that straights and turns are both hit.
std::vector<TimeNs> many_kidnaps() {
  std::vector<TimeNs> out;
  for (TimeNs t = kSecond; t < 70 * kSecond; t += 7 * kSecond) out.push_back(t + 123'456'789);
  return out;
}

TEST(Drive, KidnapMovesFarWithoutTheImuNoticing) {
  for (const char* name : {"box", "corridor", "office", "hall"}) {
    const Scenario scenario = *make_scenario(name);
    const Drive d = Drive::plan(scenario.route, scenario.style, 3, 75 * kSecond, many_kidnaps());
    ASSERT_EQ(d.teleports().size(), many_kidnaps().size());
    for (const Teleport& jump : d.teleports()) {
      const double metres = (jump.after.translation - jump.before.translation).norm();
      const double radians = so3::angle_between(jump.after.rotation, jump.before.rotation);
      EXPECT_TRUE(metres >= 3 || radians >= std::numbers::pi / 4) << metres << " " << radians;
      EXPECT_EQ(d.at(jump.t).T_map_body.translation, jump.after.translation);

      const MotionState before = d.at(jump.t - 1);  // one nanosecond: moves by 1e-9 of all rates
      const MotionState after = d.at(jump.t);
      const auto felt = [](const MotionState& s, const Vector3d& v) -> Vector3d {
        return s.T_map_body.rotation.conjugate() * v;
      };
      const Vector3d up = Vector3d::UnitZ();
      EXPECT_NEAR((before.T_map_body.translation - jump.before.translation).norm(), 0, 1e-8);
      EXPECT_NEAR((felt(before, up) - felt(after, up)).norm(), 0, 1e-8) << "tilt";
      EXPECT_NEAR((felt(before, before.v_map) - felt(after, after.v_map)).norm(), 0, 1e-7);
      EXPECT_NEAR((felt(before, before.a_map) - felt(after, after.a_map)).norm(), 0, 1e-6);
      EXPECT_NEAR((before.omega_body - after.omega_body).norm(), 0, 1e-7);
    }
  }
}

TEST(Drive, MovesOnSmoothlyAfterAKidnap) {
  const Scenario scenario = *make_scenario("office");
  const Drive d = Drive::plan(scenario.route, scenario.style, 5, 75 * kSecond, many_kidnaps());
  constexpr TimeNs kStep = kSecond / 1000;
  for (TimeNs t = 0; t < d.duration(); t += kStep) {
    const MotionState a = d.at(t);
    const MotionState b = d.at(t + kStep);
    const Eigen::Quaterniond turn = a.T_map_body.rotation.conjugate();
    const Vector3d felt_a = turn * a.a_map;
    const Vector3d felt_b = b.T_map_body.rotation.conjugate() * b.a_map;
    ASSERT_LT((felt_b - felt_a).norm(), 0.05) << to_seconds(t);  // below 50 m/s^3
    ASSERT_LT(a.a_map.norm(), 3.0) << to_seconds(t);
    ASSERT_LT((b.omega_body - a.omega_body).norm(), 0.02) << to_seconds(t);  // below 20 rad/s^2
  }
}

}  // namespace
}  // namespace holdfast::simulation
