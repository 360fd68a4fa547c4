#include <nlohmann/json.hpp>

#include "holdfast/io/tum_file.hpp"
#include "tests/interface/workspace.hpp"

namespace holdfast::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The log of a drive, with a kidnap, made once for all tests of a process. No map.
class OdometryCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    files = new Workspace;
    expect_run("simulate office --seed 3 --duration 4 --event kidnap@3 --out " + *files / "sim", 0);
  }
  static void TearDownTestSuite() {
    delete files;
    files = nullptr;
  }
  static std::string log() { return *files / "sim/run.bag"; }
  static Workspace* files;
  Workspace out;
};
Workspace* OdometryCommand::files = nullptr;

TEST_F(OdometryCommand, WritesALineForEachScanFromTheIdentityOn) {
  const std::string run = out / "run";
  expect_run("odometry " + log() + " --out " + run, 0, "run written to");
  const auto track = io::read_tum(run + "/odometry.tum");
  ASSERT_TRUE(track) << track.error().message;
  const auto summary = nlohmann::json::parse(content(run + "/summary.json"));
  EXPECT_EQ(summary["method"], "odometry");
  EXPECT_EQ(summary["scans"], track->size());
  EXPECT_EQ(lines_of(content(run + "/steps.csv")).size(), 1 + track->size());
  const SE3& first = track->front().T_map_body;
  EXPECT_EQ(first.translation.norm(), 0);
  // Levelled, without a heading of its own: x stays ahead.
  EXPECT_NEAR((first.rotation * Eigen::Vector3d::UnitX()).y(), 0, 1e-6);
  EXPECT_EQ(out.names(), std::vector<std::string>{"run"});
}

TEST_F(OdometryCommand, ABreakIsAnEventAndCountsTheEpochUp) {
  const std::string run = out / "run";
  expect_run("odometry " + log() + " --out " + run, 0, "1 breaks");
  EXPECT_THAT(content(run + "/events.jsonl"), HasSubstr("\"event\":\"odom_break\",\"from\":0,"));
  const auto summary = nlohmann::json::parse(content(run + "/summary.json"));
  EXPECT_EQ(summary["counters"]["odom_breaks"], 1);
}

TEST_F(OdometryCommand, ThreadsDoNotChangeTheTrajectoryAndTheConfigurationIsReadBack) {
  expect_run("odometry " + log() + " --out " + out / "one --set odometry.keyframe_m=0.4", 0);
  expect_run(
      "odometry " + log() + " --threads 2 --out " + out / "two --config " + out / "one/config.yaml",
      0);
  EXPECT_EQ(content(out / "one/odometry.tum"), content(out / "two/odometry.tum"));
  EXPECT_THAT(content(out / "two/config.yaml"), HasSubstr("keyframe_m: 0.4"));
}

TEST_F(OdometryCommand, WhatCannotBeDoneIsSaidAndLeavesNothing) {
  expect_run("odometry", 2);
  expect_run("odometry " + log(), 2, "--out");
  const std::string config = " --config " + *files / "sim/config.yaml";
  expect_run("odometry " + out / "none.bag" + config + " --out " + out / "run", 1, "none.bag");
  expect_run("odometry " + out / "none.bag --out " + out / "run", 1, "T_body_lidar");
  expect_run("odometry " + log() + " --scans 500: --out " + out / "run", 1, "no scan");
  expect_run("odometry " + log() + " --set odometry.gate=1 --out " + out / "run", 1, "gate_m");
  expect_run("odometry --help", 0, "without a map");
  EXPECT_THAT(out.names(), ElementsAre());
}

}  // namespace
}  // namespace holdfast::testing
