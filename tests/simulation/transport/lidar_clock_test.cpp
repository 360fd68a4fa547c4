#include "simulation/transport/lidar_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/simulation/support.hpp"
#include "tests/simulation/tolerances.hpp"

namespace holdfast::simulation {
namespace {

using testing::event;
using testing::make;
using testing::noise_free;
using testing::record;

Scan scan_at(TimeNs stamp) {
  Scan scan;
  scan.stamp = stamp;
  scan.end_time = stamp + kSecond / 10;
  scan.points.resize(2);
  scan.points[1].time_offset_ns = kSecond / 10;
  return scan;
}

LidarClockModel drifting() {
  LidarClockModel model;
  model.offset_sigma_s = 0.005;
  model.drift_sigma_ppm = 20;
  return model;
}

TEST(LidarClock, OffsetAndDriftHaveTheirSizesOverSeeds) {
  constexpr int kSeeds = 400;
  double offsets = 0;
  double drifts = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const LidarClock clock(drifting(), {}, seed);
    offsets += std::pow(clock.offset_s() / 0.005, 2);
    drifts += std::pow(clock.drift_ppm() / 20, 2);
    const double ahead_s = to_seconds(clock.read(1000 * kSecond) - 1000 * kSecond);
    // Times are whole nanoseconds.
    ASSERT_NEAR(ahead_s, clock.offset_s() + 1e-3 * clock.drift_ppm(), 1e-9);
  }
  EXPECT_NEAR(offsets / kSeeds, 1, tolerances::variance_error(kSeeds));
  EXPECT_NEAR(drifts / kSeeds, 1, tolerances::variance_error(kSeeds));
}

TEST(LidarClock, StampsScansAndFindsBackTheirTrueTimes) {
  LidarClock clock(drifting(), {}, 3);
  const Scan truth = scan_at(20 * kSecond);
  Scan stamped = truth;
  clock.stamp(stamped, 7);
  EXPECT_EQ(stamped.stamp, clock.read(truth.stamp));
  const double pace = 1 + 1e-6 * clock.drift_ppm();
  EXPECT_NE(stamped.points[1].time_offset_ns, kSecond / 10) << "20 ppm of 0.1 s are 2 us";
  EXPECT_NEAR(stamped.points[1].time_offset_ns, pace * 1e8, 1);
  EXPECT_EQ(stamped.end_time, stamped.stamp + stamped.points[1].time_offset_ns);
  const Scan back = clock.in_true_time(stamped);
  EXPECT_EQ(back.stamp, truth.stamp);
  EXPECT_NEAR(back.points[1].time_offset_ns, truth.points[1].time_offset_ns, 1);
}

TEST(LidarClock, EachStampJittersOnItsOwn) {
  LidarClockModel model;
  model.jitter_sigma_s = 0.001;
  LidarClock clock(model, {}, 1);
  constexpr int kScans = 2000;
  double squares = 0;
  double lagged = 0;
  double last = 0;
  for (int i = 0; i < kScans; ++i) {
    Scan scan = scan_at(i * kSecond / 10);
    clock.stamp(scan, static_cast<std::size_t>(i));
    const double jitter = to_seconds(scan.stamp - i * kSecond / 10) / 0.001;
    EXPECT_EQ(scan.points[1].time_offset_ns, kSecond / 10) << "within a scan nothing jitters";
    squares += jitter * jitter;
    lagged += jitter * last;
    last = jitter;
  }
  EXPECT_NEAR(squares / kScans, 1, tolerances::variance_error(kScans));
  EXPECT_NEAR(lagged / kScans, 0, tolerances::mean_error(1, kScans));
}

TEST(LidarClock, JumpsForGoodOrForAWhile) {
  const auto jumps =
      draw_clock_jumps({event("clock_jump@9"), event("clock_jump@3+2")}, LidarClockModel(), 5);
  ASSERT_EQ(jumps.size(), 2U);
  EXPECT_FALSE(jumps[0].is_for_good());
  EXPECT_TRUE(jumps[1].is_for_good());
  const LidarClock clock(LidarClockModel(), jumps, 5);
  EXPECT_EQ(clock.read(3 * kSecond - 1), 3 * kSecond - 1);
  EXPECT_EQ(clock.read(3 * kSecond), 3 * kSecond + jumps[0].step);
  EXPECT_EQ(clock.read(5 * kSecond), 5 * kSecond);
  EXPECT_EQ(clock.read(900 * kSecond), 900 * kSecond + jumps[1].step);
}

TEST(LidarClock, JumpsAreOf20To100MillisecondsEitherWay) {
  int back = 0;
  double least = 1;
  double most = 0;
  constexpr int kSeeds = 200;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const auto jump = draw_clock_jumps({event("clock_jump@1")}, LidarClockModel(), seed).front();
    back += jump.step < 0 ? 1 : 0;
    least = std::min(least, std::abs(to_seconds(jump.step)));
    most = std::max(most, std::abs(to_seconds(jump.step)));
  }
  EXPECT_GE(least, 0.02);
  EXPECT_LE(most, 0.1);
  EXPECT_LT(least, 0.025) << "missed by 200 draws once in 3e5 times";
  EXPECT_GT(most, 0.095);
  EXPECT_NEAR(back / 200.0, 0.5, tolerances::mean_error(0.5, kSeeds));
}

/// All that differs between a right and a wrong clock are the stamps; truth stays in true time.
TEST(LidarClock, OfASimulationChangesStampsOnly) {
  SimulationOptions options = noise_free("box", 4);
  const auto right = make(options);
  options.transport.lidar_clock = TransportModel::unsynchronised_clock();
  options.events = {event("clock_jump@2")};
  const auto wrong = make(options);
  const auto truth = record(*right);
  const auto log = record(*wrong);
  ASSERT_EQ(log.scans.size(), truth.scans.size());
  ASSERT_EQ(log.imu.size(), truth.imu.size());
  EXPECT_EQ(log.imu.back().t, truth.imu.back().t);
  EXPECT_EQ(wrong->truth().back().T_map_body.translation,
            right->truth().back().T_map_body.translation);
  const double step_s = wrong->events().front().clock_step_s;
  EXPECT_GE(std::abs(step_s), 0.02);
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    const TimeNs since = truth.scans[i].stamp - right->start_time();
    const double ahead_s = to_seconds(log.scans[i].stamp - truth.scans[i].stamp);
    const double expected_s =
        to_seconds(wrong->lidar_clock().read(since) - since);  // with the step
    EXPECT_NEAR(ahead_s, expected_s, 6 * 0.0005) << "six sigma of the jitter";
    EXPECT_EQ(since >= 2 * kSecond, std::abs(ahead_s - wrong->lidar_clock().offset_s()) > 0.01);
    ASSERT_EQ(log.scans[i].points.size(), truth.scans[i].points.size());
    EXPECT_EQ(log.scans[i].points[99].x, truth.scans[i].points[99].x);
  }
}

TEST(LidarClock, TrueSurfacesAreFoundInSpiteOfIt) {
  SimulationOptions options = noise_free("box", 4);
  options.transport.lidar_clock.offset_sigma_s = 0.2;
  const auto simulation = make(options);
  const auto log = record(*simulation);
  const Scan& scan = log.scans.back();
  const auto surfaces = simulation->true_geometry(scan);
  ASSERT_EQ(surfaces.size(), scan.points.size());
  const TimeNs ahead = from_seconds(simulation->lidar_clock().offset_s());
  for (std::size_t i = 0; i < surfaces.size(); i += 97) {
    const TimeNs fired = scan.stamp - ahead + scan.points[i].time_offset_ns;
    const SE3 T_map_lidar = simulation->truth_at(fired) * options.lidar.T_body_lidar;
    const Eigen::Vector3d p_map = T_map_lidar * testing::position(scan.points[i]);
    ASSERT_LT((p_map - surfaces[i].point_map).norm(), tolerances::kRayInRoom * 10);
  }
}

}  // namespace
}  // namespace holdfast::simulation
