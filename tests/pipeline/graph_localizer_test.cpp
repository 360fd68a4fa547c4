#include <gtest/gtest.h>

#include <cmath>

#include "tests/integration/drive_in_map.hpp"

/// What the graph bears: drives with events.
namespace holdfast::testing {
namespace {

simulation::SimulationOptions drive_of(const std::string& scenario, double seconds,
                                       const std::string& event = "") {
  simulation::SimulationOptions options;
  options.scenario = scenario;
  options.duration_s = seconds;
  if (!event.empty()) options.events = {*simulation::parse_event(event)};
  return options;
}

/// Errors of the poses that were claimed, m.
struct Errors {
  double root_mean_square = 0;
  double largest = 0;
  std::size_t claims = 0;
};

Errors errors_of(const SurveyedDrive& drive, const std::vector<StepReport>& reports) {
  Errors errors;
  double squares = 0;
  for (const StepReport& r : reports) {
    if (!claims_pose(r.state)) continue;
    const double error = drive.error_m(r);
    squares += error * error;
    errors.largest = std::max(errors.largest, error);
    ++errors.claims;
  }
  errors.root_mean_square = std::sqrt(squares / static_cast<double>(errors.claims));
  return errors;
}

TEST(TheGraph, KeepsThePoseThroughTwoSecondsWithoutImuAndAfterThem) {
  SurveyedDrive drive(drive_of("corridor", 26.0, "imu_off@20+2"));
  drive.method = "graph";
  const auto reports = drive.localize();
  const Errors errors = errors_of(drive, reports);
  EXPECT_GE(errors.claims + 5, reports.size());
  EXPECT_LT(errors.root_mean_square, 0.004);
  EXPECT_LT(errors.largest, 0.02);
}

TEST(TheGraph, KeepsThePoseWithoutImuFromHalfWayOn) {
  SurveyedDrive drive(drive_of("office", 20.0));
  drive.method = "graph";
  const TimeNs half = drive.simulation->start_time() + 10 * kSecond;
  Altered log(*drive.simulation, [half](SensorEvent& event) {
    const auto* imu = std::get_if<ImuSample>(&event);
    return imu == nullptr || imu->t <= half;
  });
  const auto reports = drive.localize(log);
  const Errors errors = errors_of(drive, reports);
  EXPECT_GE(errors.claims + 5, reports.size());
  EXPECT_LT(errors.root_mean_square, 0.006);
  EXPECT_LT(errors.largest, 0.03);
}

}  // namespace
}  // namespace holdfast::testing
