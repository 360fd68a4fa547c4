#include "simulation/transport/losses.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/simulation/support.hpp"
#include "tests/simulation/tolerances.hpp"

namespace holdfast::simulation {
namespace {

using testing::make;
using testing::noise_free;
using testing::record;

TEST(Losses, HaveTheirShareAndTheirRuns) {
  constexpr std::size_t kCount = 400000;
  for (const LossModel model : {LossModel{0.02, 3}, LossModel{0.1, 1}, LossModel{0.3, 10}}) {
    const auto lost = draw_losses(model, kCount, RandomStream(1, "losses"));
    double share = 0;
    double runs = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
      share += lost[i] ? 1 : 0;
      runs += lost[i] && (i == 0 || !lost[i - 1]) ? 1 : 0;
    }
    // Runs are geometric, with a sigma below their mean; a share comes from so many of them, with
    // gaps of random length between, each of which adds its like.
    const double error = 2 * tolerances::mean_error(1, runs);
    EXPECT_NEAR(share / runs / model.mean_run, 1, error) << model.mean_run;
    EXPECT_NEAR(share / kCount / model.lost_share, 1, error) << model.lost_share;
  }
}

SimulationOptions lossy(double duration_s) {
  SimulationOptions options = noise_free("box", duration_s);
  options.lidar.keep_all_returns = true;
  options.transport = options.transport.with_losses();
  return options;
}

std::set<TimeNs> columns_of(const Scan& scan, TimeNs begin, const LidarModel& lidar) {
  std::set<TimeNs> columns;
  for (const ScanPoint& point : scan.points) {
    const TimeNs since = scan.stamp + point.time_offset_ns - begin;
    columns.insert((since + 1) * lidar.columns / lidar.period);
  }
  return columns;
}

TEST(Losses, TakeWholePacketsOutOfScansAndNothingElse) {
  SimulationOptions options = lossy(6);
  const auto all = [&] {
    SimulationOptions complete = options;
    complete.transport = {};
    return record(*make(complete));
  }();
  const auto log = record(*make(options));
  ASSERT_EQ(log.scans.size(), all.scans.size());
  std::size_t lost = 0;
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    const TimeNs begin = all.scans[i].stamp;  // every ray returns
    const auto left = columns_of(log.scans[i], begin, options.lidar);
    for (int packet = 0; packet < 75; ++packet) {
      const auto count =
          std::distance(left.lower_bound(24 * packet), left.lower_bound(24 * (packet + 1)));
      ASSERT_TRUE(count == 0 || count == 24) << count << " of 24 columns";
      lost += count == 0 ? 1 : 0;
    }
    EXPECT_EQ(log.scans[i].points.size(), left.size() * 16);
    EXPECT_EQ(log.scans[i].points.front().time_offset_ns, 0);
    EXPECT_EQ(log.scans[i].end_time,
              log.scans[i].stamp + log.scans[i].points.back().time_offset_ns);
  }
  const double packets = 75.0 * static_cast<double>(log.scans.size());
  const double error = 2 * tolerances::mean_error(1, packets * 0.02 / 3);
  EXPECT_NEAR(static_cast<double>(lost) / packets / 0.02, 1, error);
}

TEST(Losses, OfTheImuLeaveTheOtherSamplesAsTheyAre) {
  SimulationOptions options;
  options.scenario = "box";
  options.duration_s = 60;
  options.lidar.columns = 1;
  const auto all = record(*make(options));
  options.transport.imu_samples = {0.05, 2};
  const auto log = record(*make(options));
  std::size_t at = 0;
  for (const ImuSample& sample : log.imu) {
    while (all.imu.at(at).t != sample.t) ++at;
    ASSERT_EQ(sample.gyro_rad_s, all.imu[at].gyro_rad_s);
  }
  const double lost = static_cast<double>(all.imu.size() - log.imu.size());
  const double expected = 0.05 * static_cast<double>(all.imu.size());
  EXPECT_NEAR(lost / expected, 1, 2 * tolerances::mean_error(1, expected / 2));
}

TEST(Losses, ThatCannotBeAreErrors) {
  SimulationOptions options;
  options.transport.imu_samples.lost_share = 0.7;
  EXPECT_FALSE(Simulation::create(options));
  options.transport.imu_samples = {0.1, 0.5};
  EXPECT_FALSE(Simulation::create(options));
  options.transport = {};
  options.transport.columns_per_packet = 0;
  EXPECT_FALSE(Simulation::create(options));
}

}  // namespace
}  // namespace holdfast::simulation
