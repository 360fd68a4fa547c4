#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "holdfast/io/cloud_file.hpp"
#include "tests/integration/drive_in_map.hpp"

/// A recorded map as a world, where it is installed.
namespace holdfast::testing {
namespace {

namespace fs = std::filesystem;

fs::path campus_file() {
  const auto repository = fs::path(__FILE__).parent_path().parent_path().parent_path();
  const char* folder = std::getenv("HOLDFAST_DATA");
  const fs::path data = folder != nullptr ? folder : repository.parent_path() / "shared" / "data";
  return data / "utd_campus_west" / "map.pcd";
}

// The robot sees discs that were fitted to the cloud, and is localized in the cloud itself.
TEST(CampusDrive, ThroughARecordedMapIsLocalizedInThatMap) {
  const fs::path file = campus_file();
  if (!fs::exists(file)) GTEST_SKIP() << "no map " << file;
  simulation::SimulationOptions options;
  options.scenario = file.string();
  options.duration_s = 15;
  options.threads = 2;
  const auto drive = valid(simulation::Simulation::create(options));
  EXPECT_GT(drive->scenario().route.length(), 500);
  const map::testing::BuiltMap map(valid(io::read_cloud(file)));
  const SE3 start = drive->initial_pose();
  double squares = 0;
  int claims = 0;
  const auto reports = reports_of(*drive, map, config_of(*drive), start, 2);
  for (const StepReport& report : reports) {
    if (!claims_pose(report.state)) continue;
    const SE3 truth = drive->truth_at(report.pose_time);
    squares += (report.T_map_body.translation - truth.translation).squaredNorm();
    ++claims;
  }
  EXPECT_GT(claims, 0.9 * static_cast<double>(reports.size()));
  EXPECT_LE(std::sqrt(squares / claims), 0.05);
}

}  // namespace
}  // namespace holdfast::testing
