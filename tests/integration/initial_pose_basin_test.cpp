#include <gtest/gtest.h>

#include "holdfast/core/random.hpp"
#include "tests/integration/drive_in_map.hpp"

namespace holdfast::testing {
namespace {

constexpr int kDraws = 20;
constexpr std::size_t kScans = 5;
constexpr double kMostShift = 1.0;                           // m
constexpr double kMostTurn = 10.0 * std::numbers::pi / 180;  // rad
// The noise of 20 mm a range averages out over thousands of points; what is left after five scans
// is far below the noise of one.
constexpr double kFoundM = 0.02;

Eigen::Vector3d unit_vector(RandomStream& random) {
  return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

/// A pose off by up to the limits, in any direction and about any axis.
SE3 anywhere_within(const SE3& truth, RandomStream& random) {
  const Eigen::Vector3d shift = kMostShift * random.uniform() * unit_vector(random);
  const Eigen::Vector3d turn = kMostTurn * random.uniform() * unit_vector(random);
  return {(so3::exp(turn) * truth.rotation).normalized(), truth.translation + shift};
}

/// A pose off by both limits, level: as a person sets it on a floor plan.
SE3 on_the_rim(const SE3& truth, RandomStream& random) {
  const double way = random.uniform(-std::numbers::pi, std::numbers::pi);
  const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
  const Eigen::Vector3d shift(kMostShift * std::cos(way), kMostShift * std::sin(way), 0);
  return {(so3::exp(side * kMostTurn * Eigen::Vector3d::UnitZ()) * truth.rotation).normalized(),
          truth.translation + shift};
}

class FromAPoseOffByOneMetreAndTenDegrees : public ::testing::TestWithParam<const char*> {
 protected:
  using Draw = SE3 (*)(const SE3&, RandomStream&);

  /// In how many of the draws the fifth scan has the pose.
  int found(Draw draw) {
    simulation::SimulationOptions options;
    options.scenario = GetParam();
    options.duration_s = 0.1 * static_cast<double>(kScans + 1);
    SurveyedDrive drive(options);
    const auto events = record(*drive.simulation);
    RandomStream random(1, "initial poses");
    int successes = 0;
    for (int k = 0; k < kDraws; ++k) {
      const SE3 given = draw(drive.simulation->initial_pose(), random);
      Recording log(events);
      const auto reports = reports_of(log, drive.map, config_of(*drive.simulation), given);
      const StepReport& last = reports.at(kScans - 1);
      const bool success = claims_pose(last.state) && drive.error_m(last) < kFoundM;
      successes += success ? 1 : 0;
      EXPECT_TRUE(success) << "draw " << k << ": " << to_string(last.state) << " "
                           << drive.error_m(last) << " m off";
    }
    return successes;
  }
};

TEST_P(FromAPoseOffByOneMetreAndTenDegrees, ThePoseIsFoundWithinFiveScans) {
  EXPECT_EQ(found(anywhere_within), kDraws);
}

TEST_P(FromAPoseOffByOneMetreAndTenDegrees, ThePoseIsFoundFromTheRimToo) {
  EXPECT_EQ(found(on_the_rim), kDraws);
}

INSTANTIATE_TEST_SUITE_P(In, FromAPoseOffByOneMetreAndTenDegrees,
                         ::testing::Values("office", "hall", "corridor"),
                         [](const auto& scenario) { return std::string(scenario.param); });

}  // namespace
}  // namespace holdfast::testing
