#include "simulation/sensors/wheel/wheel_odometer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "simulation/events/random_spans.hpp"
#include "simulation/scenario.hpp"
#include "tests/simulation/support.hpp"
#include "tests/simulation/tolerances.hpp"

namespace holdfast::simulation {
namespace {

constexpr TimeNs kLength = 60 * kSecond;
constexpr double kDt = 0.02;

Drive drive_through(const char* name) {
  const Scenario scenario = *make_scenario(name);
  return Drive::plan(scenario.route, scenario.style, 3, kLength, {});
}

/// Wheels that do nothing wrong but count whole ticks.
WheelModel ideal() {
  WheelModel model;
  model.scale_sigma = model.turn_slip = model.slips_per_minute = 0;
  return model;
}

/// Ways of the ground below both wheels since the start, and the way in the spans of slips.
struct Ways {
  double left = 0;
  double right = 0;
  double slipping[2] = {0, 0};
};

Ways true_ways(const Drive& drive, double track_m, const std::vector<WheelOdometer::Slip>& slips,
               TimeNs begin = 0, TimeNs end = kLength) {
  Ways ways;
  constexpr TimeNs kFine = kSecond / 1000;
  for (TimeNs t = begin + kFine / 2; t < end; t += kFine) {
    const MotionState motion = drive.at(t);
    const double forward = (motion.T_map_body.rotation.conjugate() * motion.v_map).x();
    const double apart = motion.omega_body.z() * track_m / 2;
    ways.left += 0.001 * (forward - apart);
    ways.right += 0.001 * (forward + apart);
    for (const auto& slip : slips) {
      if (!slip.span.contains(t)) continue;
      ways.slipping[slip.wheel] += 0.001 * (slip.wheel == 0 ? forward - apart : forward + apart);
    }
  }
  return ways;
}

/// What both wheels have told, summed up.
Ways told(const std::vector<WheelSample>& samples, double track_m) {
  Ways ways;
  for (const WheelSample& sample : samples) {
    ways.left += kDt * (sample.speed_m_s - sample.yaw_rate_rad_s * track_m / 2);
    ways.right += kDt * (sample.speed_m_s + sample.yaw_rate_rad_s * track_m / 2);
  }
  return ways;
}

TEST(WheelOdometer, CountsWholeTicks) {
  const Drive drive = drive_through("warehouse");
  const WheelModel model = ideal();
  const auto samples = WheelOdometer(model, 1, kLength).samples(drive);
  ASSERT_EQ(samples.size(), 3000U);
  const double tick_m = 1 / model.ticks_per_m;
  double squares = 0;
  double moving = 0;
  for (const WheelSample& sample : samples) {
    const TimeNs begin = sample.t - kSecond / 50;
    const Ways ways = true_ways(drive, model.track_m, {}, begin, sample.t);
    const double error = sample.speed_m_s - (ways.left + ways.right) / 2 / kDt;
    ASSERT_LT(std::abs(error), tick_m / kDt);
    const double ticks = 2 * sample.speed_m_s * kDt / tick_m;
    ASSERT_NEAR(ticks, std::round(ticks), 1e-6);
    if (sample.speed_m_s < 0.3) continue;
    squares += std::pow(error / sample.speed_sigma_m_s, 2);
    ++moving;
  }
  // Neighbouring errors share a cut tick and are correlated by -1/2, their squares by 1/4.
  EXPECT_NEAR(squares / moving, 1, tolerances::variance_error(moving / 1.5));
}

TEST(WheelOdometer, EachWheelHasAScaleOfItsOwn) {
  WheelModel model = ideal();
  model.scale_sigma = 0.01;
  const Drive drive = drive_through("warehouse");
  const Ways truth = true_ways(drive, model.track_m, {});
  constexpr int kSeeds = 50;
  double squares = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const WheelOdometer wheels(model, seed, kLength);
    for (const double scale : wheels.scales()) squares += std::pow(scale - 1, 2);
    if (seed > 0) continue;
    const Ways sum = told(wheels.samples(drive), model.track_m);
    EXPECT_NEAR(sum.left, wheels.scales()[0] * truth.left, 1.01 / model.ticks_per_m);
    EXPECT_NEAR(sum.right, wheels.scales()[1] * truth.right, 1.01 / model.ticks_per_m);
  }
  EXPECT_NEAR(squares / (2 * kSeeds) / 1e-4, 1, tolerances::variance_error(2 * kSeeds));
}

TEST(WheelOdometer, TurnsFurtherThanTheGround) {
  WheelModel model = ideal();
  model.turn_slip = 0.2;
  const Drive drive = drive_through("office");
  const Ways truth = true_ways(drive, model.track_m, {});
  const Ways sum = told(WheelOdometer(model, 1, kLength).samples(drive), model.track_m);
  const double turned = truth.right - truth.left;
  ASSERT_GT(std::abs(turned), 0.5);
  EXPECT_NEAR(sum.right - sum.left, 1.2 * turned, 2.02 / model.ticks_per_m);
  EXPECT_NEAR(sum.right + sum.left, truth.right + truth.left, 2.02 / model.ticks_per_m);
}

TEST(WheelOdometer, OneWheelSpinsNowAndThen) {
  WheelModel model = ideal();
  model.slips_per_minute = 20;
  const Drive drive = drive_through("warehouse");
  const WheelOdometer wheels(model, 2, kLength);
  ASSERT_GT(wheels.slips().size(), 5U);
  const Ways truth = true_ways(drive, model.track_m, wheels.slips());
  ASSERT_GT(truth.slipping[0], 0.1);
  ASSERT_GT(truth.slipping[1], 0.1);
  const Ways sum = told(wheels.samples(drive), model.track_m);
  // A span begins and ends up to half a step of 5 ms beside where it is counted, at up to 2 m/s.
  const double borders = 2.0 * static_cast<double>(wheels.slips().size()) * 0.003 * 2;
  const double tolerance = 1.01 / model.ticks_per_m + model.slip_share * borders;
  EXPECT_NEAR(sum.left, truth.left + model.slip_share * truth.slipping[0], tolerance);
  EXPECT_NEAR(sum.right, truth.right + model.slip_share * truth.slipping[1], tolerance);
  EXPECT_LT(tolerance, model.slip_share * truth.slipping[0]) << "else this shows nothing";
}

TEST(WheelOdometer, SumsUpToAPoseThatAnIdealOneFollowsTheTruthWith) {
  SimulationOptions options = testing::noise_free("warehouse", 30);
  options.lidar.columns = 1;
  options.wheel = ideal();
  options.wheel->ticks_per_m = 1e6;
  const auto simulation = testing::make(options);
  const auto samples = simulation->wheel_samples();
  const SE3 T_begin = simulation->truth_at(simulation->start_time());
  const SE3 truth = T_begin.inverse() * simulation->truth_at(samples.back().t);
  const SE3& summed = samples.back().T_odom_body;
  // Sway of 3 mrad tilts the way (it oscillates, its square does not) and weaving carries the body
  // sideways across its heading, which wheels do not see: a per cent of the way.
  EXPECT_LT((summed.translation - truth.translation).head<2>().norm(), 0.01 * 30);
  EXPECT_LT(so3::angle_between(summed.rotation, truth.rotation), 0.02);
}

TEST(WheelOdometer, DependsOnTheSeedAlone) {
  const Drive drive = drive_through("corridor");
  const auto a = WheelOdometer(WheelModel(), 4, kLength).samples(drive);
  const auto b = WheelOdometer(WheelModel(), 4, kLength).samples(drive);
  const auto c = WheelOdometer(WheelModel(), 5, kLength).samples(drive);
  EXPECT_EQ(a.back().T_odom_body.translation, b.back().T_odom_body.translation);
  EXPECT_NE(a.back().T_odom_body.translation, c.back().T_odom_body.translation);
}

TEST(RandomSpans, AreAsManyAndAsLongAsTheyShould) {
  constexpr TimeNs kDay = 24 * 3600 * kSecond;
  const auto spans = draw_spans(2, 3, kDay, RandomStream(1, "spans"));
  double total_s = 0;
  TimeNs last = 0;
  for (const TimeSpan& span : spans) {
    EXPECT_GT(span.begin, last);
    last = span.end;
    total_s += to_seconds(span.end - span.begin);
  }
  const auto n = static_cast<double>(spans.size());
  // Gaps and lengths are exponential, their sigma is their mean.
  EXPECT_NEAR(total_s / n / 3, 1, tolerances::mean_error(1, n));
  EXPECT_NEAR(n / (24 * 3600 / 33.0), 1, tolerances::mean_error(1, n));
  EXPECT_TRUE(draw_spans(0, 3, kDay, RandomStream(1, "spans")).empty());
}

}  // namespace
}  // namespace holdfast::simulation
