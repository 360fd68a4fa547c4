#include "simulation/motion/person/carry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "simulation/motion/drive.hpp"
#include "tests/simulation/support.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;
using testing::event;
using ::testing::HasSubstr;
using testing::Log;
using testing::make;
using testing::noise_free;
using testing::record;

constexpr TimeSpan kSpan{10 * kSecond, 17 * kSecond};

Drive carried_drive(const std::string& name, std::uint64_t seed) {
  const Scenario scenario = *make_scenario(name);
  return Drive::plan(scenario.route, scenario.style, seed, 25 * kSecond, {}, {kSpan});
}

TEST(Carry, MovesFarAsAPersonCould) {
  for (const char* name : {"corridor", "office", "offices", "garage", "yard"}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Drive d = carried_drive(name, seed);
      ASSERT_EQ(d.carries().size(), 1U);
      const Carry& carry = d.carries()[0];
      ASSERT_EQ(carry.needs, 0) << name << " " << seed;
      EXPECT_TRUE(d.teleports().empty());
      const double metres = (carry.after.translation - carry.before.translation).norm();
      const double radians = so3::angle_between(carry.after.rotation, carry.before.rotation);
      EXPECT_TRUE(metres >= 3 || radians >= std::numbers::pi / 4) << metres << " " << radians;
      for (TimeNs t = kSpan.begin; t < kSpan.end; t += kSecond / 100) {
        const MotionState state = d.at(t);
        ASSERT_LT(state.v_map.norm(), 3.0);
        // 4 m/s^2 of carrying; before it the robot may take a bend while it brakes with 2 m/s^2.
        ASSERT_LT(state.a_map.norm(), 4.0);
        ASSERT_LT(state.omega_body.norm(), 3.0);
      }
    }
  }
}

TEST(Carry, LiftsTheBodyAndPutsItDownAtRest) {
  const Drive d = carried_drive("corridor", 2);
  const double ground = make_scenario("corridor")->style.body_height_m;
  double highest = ground;
  for (TimeNs t = kSpan.begin; t < kSpan.end; t += kSecond / 100) {
    highest = std::max(highest, d.at(t).T_map_body.translation.z());
  }
  EXPECT_GT(highest - ground, 0.2);
  EXPECT_LT(highest - ground, 0.52) << "half a metre, and a step's heave";
  const MotionState down = d.at(kSpan.end);
  EXPECT_NEAR(down.v_map.norm(), 0, 1e-9);
  EXPECT_NEAR(down.a_map.norm(), 0, 1e-7);
  EXPECT_NEAR(down.omega_body.norm(), 0, 1e-9);
  EXPECT_NEAR(down.T_map_body.translation.z(), ground, 1e-12);
  EXPECT_GT(d.at(kSpan.end + 3 * kSecond).v_map.norm(), 0.5) << "and drives on";
}

TEST(Carry, IsContinuous) {
  for (const char* name : {"office", "garage"}) {
    const Drive d = carried_drive(name, 3);
    constexpr TimeNs kStep = kSecond / 1000;
    for (TimeNs t = 0; t < d.duration(); t += kStep) {
      const MotionState a = d.at(t);
      const MotionState b = d.at(t + kStep);
      const double dt = to_seconds(kStep);
      // Positions differ by the mean velocity, to a third derivative of 200 m/s^3 times dt^3 / 12.
      const Vector3d mean = 0.5 * (a.v_map + b.v_map);
      const Vector3d step = b.T_map_body.translation - a.T_map_body.translation;
      ASSERT_NEAR((step - dt * mean).norm(), 0, 200 * dt * dt * dt / 12) << to_seconds(t);
      ASSERT_LT((b.a_map - a.a_map).norm(), 0.2) << to_seconds(t);
      ASSERT_LT((b.omega_body - a.omega_body).norm(), 0.02) << to_seconds(t);
    }
  }
}

TEST(Carry, LeavesTheDriveBeforeItAsItWas) {
  const Scenario scenario = *make_scenario("office");
  const Drive plain = Drive::plan(scenario.route, scenario.style, 4, 25 * kSecond, {});
  const Drive d = carried_drive("office", 4);
  const TimeNs brakes = kSpan.begin - 600'000'000;  // smoothing lets it begin so much earlier
  for (TimeNs t = 0; t <= brakes; t += kSecond / 20) {
    ASSERT_EQ(plain.at(t).T_map_body.translation, d.at(t).T_map_body.translation);
  }
}

TEST(Carry, CoversTheLidarAndTruthHasOneLineAStamp) {
  SimulationOptions options = noise_free("box", 20);
  options.lidar.columns = 20;
  options.events = {event("kidnap@10+6")};
  const auto simulation = make(options);
  const Log log = record(*simulation);
  const TimeNs begin = simulation->start_time() + 10 * kSecond;
  const TimeNs end = begin + 6 * kSecond;
  std::size_t empty = 0;
  for (const Scan& scan : log.scans) {
    empty += scan.points.empty() ? 1 : 0;
    for (const ScanPoint& point : scan.points) {
      const TimeNs t = scan.stamp + point.time_offset_ns;
      ASSERT_TRUE(t < begin || t >= end);
    }
  }
  EXPECT_EQ(empty, 59U) << "six seconds, less the two scans at its ends";
  const auto truth = simulation->truth();
  for (std::size_t i = 1; i < truth.size(); ++i) ASSERT_GT(truth[i].t, truth[i - 1].t);
  ASSERT_EQ(simulation->events().size(), 1U) << "it is not told as blind as well";
  const SimulatedEvent& kidnap = simulation->events()[0];
  EXPECT_TRUE(kidnap.carried);
  EXPECT_EQ(kidnap.t0, begin);
  EXPECT_EQ(kidnap.t1, end);
  EXPECT_EQ(kidnap.pose_before.translation, simulation->truth_at(begin).translation);
  EXPECT_EQ(kidnap.pose_after.translation, simulation->truth_at(end).translation);
}

TEST(Carry, SaysHowLongItMustLast) {
  const auto message = [](const std::vector<EventSpec>& events) {
    SimulationOptions options = noise_free("corridor", 20);
    options.events = events;
    const auto simulation = Simulation::create(options);
    return simulation ? std::string("created") : simulation.error().message;
  };
  EXPECT_THAT(message({event("kidnap@10+1")}), HasSubstr("1 s are too short"));
  const std::string text = message({event("kidnap@10+1")});
  const std::size_t at = text.find("at least ");
  ASSERT_NE(at, std::string::npos) << text;
  const std::string needed = text.substr(at + 9, text.find(' ', at + 9) - at - 9);
  EXPECT_LT(std::stod(needed), 5);
  EXPECT_EQ(message({event("kidnap@10+" + needed)}), "created");
  EXPECT_THAT(message({event("kidnap@15+6")}), HasSubstr("expected an end within the log, 20 s"));
  EXPECT_THAT(message({event("kidnap@5+6"), event("kidnap@8")}),
              HasSubstr("expected no other within 2 s of it, found one at 8 s"));
  EXPECT_EQ(message({event("kidnap@3"), event("kidnap@6+6")}), "created");
}

}  // namespace
}  // namespace holdfast::simulation
