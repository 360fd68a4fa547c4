#include <gtest/gtest.h>

#include <cmath>

#include "tests/integration/drive_in_map.hpp"

/// What the methods bear: drives with events.
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

/// With an IMU that is silent or suddenly wrong, the skew of a scan depends on the motion that the
/// scan is to tell. Taken as known it would make the pose swing, ever farther.
class EachMethod : public ::testing::TestWithParam<const char*> {
 protected:
  static void expect_millimetres(simulation::SimulationOptions options) {
    SurveyedDrive drive(std::move(options));
    drive.method = GetParam();
    const auto reports = drive.localize();
    const Errors errors = errors_of(drive, reports);
    EXPECT_GE(errors.claims + 5, reports.size());
    EXPECT_LT(errors.root_mean_square, 0.004);
    EXPECT_LT(errors.largest, 0.02);
  }
};

TEST_P(EachMethod, KeepsThePoseThroughTwoSecondsWithoutImuAndAfterThem) {
  expect_millimetres(drive_of("corridor", 26.0, "imu_off@20+2"));
}

TEST_P(EachMethod, SurvivesAJumpOfTheImuBiases) {
  auto options = drive_of("corridor", 18.0, "imu_bias_jump@15");
  options.seed = 4;
  expect_millimetres(std::move(options));
}

INSTANTIATE_TEST_SUITE_P(Of, EachMethod, ::testing::Values("map_filter", "graph"),
                         [](const auto& method) { return std::string(method.param); });

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

/// The part of a map below x = `end_m`.
io::PointCloud left_of(const io::PointCloud& map, double end_m) {
  io::PointCloud part = map;
  std::erase_if(part.points, [&](const Eigen::Vector3f& p) {
    return p.cast<double>().x() + map.origin.x() > end_m;
  });
  return part;
}

/// A drive into a part of the building that the map does not show, and back.
struct DriveBeyondTheMap {
  explicit DriveBeyondTheMap(const std::string& odometry)
      : simulation(valid(simulation::Simulation::create(drive_of("office", 22.0)))),
        map(left_of(simulation->survey_map(), 4.5)) {
    pipeline::Config config = config_of(*simulation);
    config.method = "graph";
    config.graph.odometry = odometry;
    const SE3 start = simulation->initial_pose();
    reports = reports_of(*simulation, map, config, start);
  }

  double error_m(const StepReport& r) const {
    return (r.T_map_body.translation - simulation->truth_at(r.pose_time).translation).norm();
  }

  std::unique_ptr<simulation::Simulation> simulation;
  map::testing::BuiltMap map;
  std::vector<StepReport> reports;
};

/// What the odometry may be off by outside of the map, m, after so many metres of way.
double allowed_m(double way_m) { return 0.01 + 0.005 * way_m; }

TEST(TheGraph, IsCarriedOnByOdometryOutsideOfTheMapAndFindsBackInside) {
  const DriveBeyondTheMap drive("on");
  double way = 0;
  int unmapped = 0;
  const StepReport* last = nullptr;
  for (const StepReport& r : drive.reports) {
    if (!claims_pose(r.state)) continue;
    if (r.state == State::kUnmapped) {
      if (last != nullptr) way += (r.T_map_body.translation - last->T_map_body.translation).norm();
      ++unmapped;
      EXPECT_LT(drive.error_m(r), allowed_m(way));
      EXPECT_LT(drive.error_m(r), 4 * r.sigma_trans_m + 0.005);
    } else {
      EXPECT_LT(drive.error_m(r), 0.02);
    }
    last = &r;
  }
  EXPECT_GE(unmapped, 40);
  EXPECT_EQ(drive.reports.back().state, State::kTracking);
  EXPECT_GE(way, 2.0);
}

TEST(TheGraph, WithoutOdometryIsCarriedAwayOutsideOfTheMap) {
  const DriveBeyondTheMap with("on");
  const DriveBeyondTheMap without("off");
  double way = 0;
  bool beyond = false;
  for (std::size_t i = 1; i < with.reports.size(); ++i) {
    if (with.reports[i].state != State::kUnmapped) continue;
    way += (with.reports[i].T_map_body.translation - with.reports[i - 1].T_map_body.translation)
               .norm();
    beyond = beyond || without.error_m(without.reports[i]) > allowed_m(way);
  }
  EXPECT_TRUE(beyond);
}

}  // namespace
}  // namespace holdfast::testing
