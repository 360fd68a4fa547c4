#include <gtest/gtest.h>

#include <vector>

#include "holdfast/pipeline/event_sequencer.hpp"
#include "holdfast/pipeline/methods/odometry_run.hpp"
#include "tests/integration/drive_in_map.hpp"

/// Logs that begin in the middle of a drive.
namespace holdfast::odometry {
namespace {

constexpr int kScans = 11;  // a second
constexpr std::size_t kImuBefore = 60;

using holdfast::testing::valid;

/// The events of a simulated drive, in order.
struct Recording {
  std::unique_ptr<simulation::Simulation> world;
  std::vector<SensorEvent> events;
  std::vector<std::size_t> scans;  ///< places in `events`

  explicit Recording(const char* scenario) {
    simulation::SimulationOptions options;
    options.scenario = scenario;
    options.seed = 21;
    options.duration_s = 30;
    world = valid(simulation::Simulation::create(options));
    pipeline::EventSequencer sequencer;
    while (auto event = valid(world->next())) {
      sequencer.push(std::move(*event));
      take(sequencer);
    }
    sequencer.finish();
    take(sequencer);
  }

  void take(pipeline::EventSequencer& sequencer) {
    SensorEvent event;
    while (sequencer.pop(event)) {
      if (std::holds_alternative<Scan>(event)) scans.push_back(events.size());
      events.push_back(std::move(event));
    }
  }

  /// Error in metres of the way of a second, for an odometry that begins with scan `first`.
  double error_m(std::size_t first) const {
    pipeline::Config config;
    config.T_body_lidar = world->options().lidar.T_body_lidar;
    Odometry odometry(pipeline::odometry_setup(config));
    std::vector<SE3> ways, truths;
    for (std::size_t i = scans[first] - kImuBefore; ways.size() < kScans; ++i) {
      if (const auto* imu = std::get_if<ImuSample>(&events[i])) odometry.add_imu(*imu);
      if (i < scans[first] || !std::holds_alternative<Scan>(events[i])) continue;
      const OdometryReport report = odometry.add_scan(std::get<Scan>(events[i]));
      ways.push_back(report.step.T_map_body);
      truths.push_back(world->truth_at(report.step.pose_time));
    }
    const SE3 way = ways.front().inverse() * ways.back();
    const SE3 truth = truths.front().inverse() * truths.back();
    return (way.translation - truth.translation).norm();
  }
};

class StartOnTheMove : public ::testing::TestWithParam<const char*> {};

/// The planes of a corridor, and those of a street, say nothing about the way along it: a robot
/// that was taken to rest stayed where it was while it went on at 1.2 m/s, in 7 of 10 starts.
TEST_P(StartOnTheMove, MostStartsKnowTheWayOfTheFirstSecond) {
  const Recording recording(GetParam());
  int starts = 0, good = 0;
  for (std::size_t first = 40; first + kScans < recording.scans.size(); first += 12) {
    ++starts;
    good += recording.error_m(first) < 0.1 ? 1 : 0;
  }
  ASSERT_GE(starts, 15);
  EXPECT_GE(good, starts * 7 / 10) << good << " of " << starts;
}

INSTANTIATE_TEST_SUITE_P(Scenarios, StartOnTheMove,
                         ::testing::Values("corridor", "office", "yard", "warehouse"));

}  // namespace
}  // namespace holdfast::odometry
