#include "holdfast/places/place_maker.hpp"
#include "tests/integration/drive_in_map.hpp"

/// Simulated drives that begin without a pose, or in which the robot is carried away.
namespace holdfast::testing {
namespace {

constexpr double kFoundM = 0.3;  // a recovery: within this and...
constexpr double kFoundDeg = 5.0;
constexpr double kFalseM = 0.5;  // a false relocalization: accepted, and farther off

simulation::SimulationOptions drive_of(const std::string& scenario, double duration_s) {
  simulation::SimulationOptions options;
  options.scenario = scenario;
  options.duration_s = duration_s;
  options.seed = 5;
  return options;
}

/// A drive and the map of its survey, with places.
class RecoveryDrive {
 public:
  explicit RecoveryDrive(const simulation::SimulationOptions& options)
      : simulation(valid(simulation::Simulation::create(options))) {
    WorkerPool pool;
    valid(places::build_map({simulation->survey_map(), std::nullopt, "test"}, map_dir(), pool));
  }

  std::vector<StepReport> localize(const std::optional<SE3>& T_map_body) {
    auto map = valid(map::PriorMap::open(map_dir()));
    auto localizer =
        valid(pipeline::Localizer::create(config_of(*simulation), std::move(map), T_map_body));
    std::vector<StepReport> reports;
    valid(pipeline::run(*simulation, localizer, [&](const StepReport& report, double) -> Status {
      reports.push_back(report);
      return Done{};
    }));
    return reports;
  }

  double error_m(const StepReport& report) const {
    return (report.T_map_body.translation - simulation->truth_at(report.pose_time).translation)
        .norm();
  }
  bool is_found(const StepReport& report) const {
    const double turned = so3::angle_between(report.T_map_body.rotation,
                                             simulation->truth_at(report.pose_time).rotation) *
                          180.0 / std::numbers::pi;
    return (report.state == State::kTracking || report.state == State::kDegraded) &&
           error_m(report) < kFoundM && turned < kFoundDeg;
  }

  std::filesystem::path map_dir() const { return folder_.path() / "map"; }
  std::unique_ptr<simulation::Simulation> simulation;

 private:
  map::testing::ScratchFolder folder_;
};

/// Seconds from `since` to the first report from which on all are found; none: the last is not.
std::optional<double> found_after_s(const RecoveryDrive& drive,
                                    const std::vector<StepReport>& reports, TimeNs since) {
  std::optional<double> found;
  for (const StepReport& r : reports) {
    if (r.pose_time < since) continue;
    if (!drive.is_found(r))
      found.reset();
    else if (!found)
      found = to_seconds(r.pose_time - since);
  }
  return found;
}

void expect_no_false_relocalization(const RecoveryDrive& drive,
                                    const std::vector<StepReport>& reports) {
  for (const StepReport& r : reports) {
    if (r.search && r.search->accepted) {
      EXPECT_LT(drive.error_m(r), kFalseM) << r.search->reason;
    }
  }
}

class ARecovery : public ::testing::TestWithParam<const char*> {};

TEST_P(ARecovery, FindsTheRobotWithoutAPose) {
  RecoveryDrive drive(drive_of(GetParam(), 8.0));
  const auto reports = drive.localize(std::nullopt);
  const auto found = found_after_s(drive, reports, drive.simulation->start_time());
  ASSERT_TRUE(found);
  EXPECT_LT(*found, 3.0);
  expect_no_false_relocalization(drive, reports);
}

TEST_P(ARecovery, FindsARobotThatWasCarriedAway) {
  auto options = drive_of(GetParam(), 14.0);
  options.events = {*simulation::parse_event("kidnap@6")};
  RecoveryDrive drive(options);
  const auto reports = drive.localize(drive.simulation->initial_pose());
  const TimeNs event = drive.simulation->start_time() + 6 * kSecond;
  const auto found = found_after_s(drive, reports, event);
  ASSERT_TRUE(found);
  EXPECT_LT(*found, 3.0);
  EXPECT_EQ(std::count_if(reports.begin(), reports.end(),
                          [](const auto& r) { return r.search && r.search->accepted; }),
            1);
  expect_no_false_relocalization(drive, reports);
}

INSTANTIATE_TEST_SUITE_P(In, ARecovery, ::testing::Values("office", "yard"),
                         [](const auto& scenario) { return std::string(scenario.param); });

TEST(ARecoveryDrive, IsTheSameWheneverItIsPlayed) {
  const auto options = drive_of("office", 4.0);
  std::vector<Eigen::Vector3d> ends;
  for (int time = 0; time < 2; ++time) {
    RecoveryDrive drive(options);
    const auto reports = drive.localize(std::nullopt);
    EXPECT_TRUE(claims_pose(reports.back().state));
    ends.push_back(reports.back().T_map_body.translation);
  }
  EXPECT_EQ(ends[0], ends[1]);
}

TEST(ARecoveryDrive, InAMapWithoutPlacesBeginsWithAPoseOrNotAtAll) {
  const SurveyedDrive drive(drive_of("office", 1.0));
  const auto localizer =
      pipeline::Localizer::create(config_of(*drive.simulation), drive.map.open(), std::nullopt);
  ASSERT_FALSE(localizer);
  EXPECT_NE(localizer.error().message.find("places"), std::string::npos);
}

}  // namespace
}  // namespace holdfast::testing
