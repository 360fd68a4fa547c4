#include <nlohmann/json.hpp>

#include "holdfast/io/tum_file.hpp"
#include "tests/interface/workspace.hpp"

namespace holdfast::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// The drive is made once for all tests of a process.
class LocalizeCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { drive = new SmallDrive; }
  static void TearDownTestSuite() {
    delete drive;
    drive = nullptr;
  }
  static SmallDrive* drive;
  Workspace out;
};
SmallDrive* LocalizeCommand::drive = nullptr;

TEST_F(LocalizeCommand, TheWholeWayFromASimulationToItsEvaluation) {
  for (const char* name : {"run.bag", "truth.tum", "events.jsonl", "map.pcd", "config.yaml"}) {
    EXPECT_TRUE(fs::exists(fs::path(drive->sim) / name)) << name;
  }
  const std::string run = out / "run";
  const auto told =
      expect_run(drive->localize(run, "--truth " + drive->sim + "/truth.tum"), 0, "tracked");
  EXPECT_THAT(told.out, HasSubstr(run));
  for (const char* name : {"trajectory.tum", "steps.csv", "events.jsonl", "summary.json",
                           "config.yaml", "map_view.json", "report.html"}) {
    EXPECT_TRUE(fs::exists(fs::path(run) / name)) << name;
  }
  const auto trajectory = io::read_tum(run + "/trajectory.tum");
  ASSERT_TRUE(trajectory) << trajectory.error().message;
  const auto summary = nlohmann::json::parse(content(run + "/summary.json"));
  const std::size_t scans = lines_of(content(run + "/steps.csv")).size() - 1;
  EXPECT_EQ(summary["scans"], scans);
  EXPECT_EQ(summary["claimed"], trajectory->size());
  EXPECT_GE(trajectory->size() + 5, scans);  // half a second may pass before the first claim
  EXPECT_EQ(out.names(), std::vector<std::string>{"run"});

  const auto evaluated = expect_run(
      "evaluate " + run + "/trajectory.tum --truth " + drive->sim + "/truth.tum --json", 0);
  EXPECT_FALSE(nlohmann::json::parse(evaluated.out, nullptr, false).is_discarded())
      << evaluated.out;
}

TEST_F(LocalizeCommand, TheConfigurationOfARunIsReadBack) {
  expect_run(drive->localize(out / "first", "--no-report --set start.position_m=0.5"), 0);
  EXPECT_FALSE(fs::exists(out / "first/report.html"));
  expect_run(drive->localize(out / "second", "--no-report --config " + out / "first/config.yaml"),
             0);
  EXPECT_EQ(content(out / "first/config.yaml"), content(out / "second/config.yaml"));
  EXPECT_THAT(content(out / "first/config.yaml"), HasSubstr("position_m: 0.5"));
  EXPECT_EQ(content(out / "first/trajectory.tum"), content(out / "second/trajectory.tum"));
}

TEST_F(LocalizeCommand, ThreadsDoNotChangeTheTrajectory) {
  expect_run(drive->localize(out / "one", "--no-report --threads 1"), 0);
  expect_run(drive->localize(out / "two", "--no-report --threads 2"), 0);
  EXPECT_EQ(content(out / "one/trajectory.tum"), content(out / "two/trajectory.tum"));
}

TEST_F(LocalizeCommand, ASliceOfTheScansIsUsed) {
  const std::string run = out / "run";
  expect_run(drive->localize(run, "--no-report --scans 0:20:2"), 0);
  EXPECT_EQ(lines_of(content(run + "/steps.csv")).size(), 1U + 10U);
  expect_run(drive->localize(out / "none", "--no-report --scans 500:"), 1, "no scan");
  for (const char* bad : {"a:b", "1:2:3:4", "-5:", "::0", "0:10:-1", "1x"}) {
    expect_run(drive->localize(out / "none", std::string("--scans ") + bad), 2, "--scans");
  }
  EXPECT_THAT(out.names(), ElementsAre("run"));
}

/// Each of these fails, says why, and leaves nothing.
TEST_F(LocalizeCommand, WhatIsMissingIsNamed) {
  const std::string map = " --map " + drive->map;
  const std::string pose = " --initial-pose \"" + drive->pose + "\"";
  const std::string config = " --config " + drive->sim + "/config.yaml";
  const std::string to = " --out " + out / "run";
  expect_run("localize " + drive->log + to + pose, 2, "--map");
  expect_run("localize " + drive->log + map + pose, 2, "--out");
  expect_run("localize" + map + to + pose, 2, "log");
  expect_run("localize /nowhere/run.bag" + map + to + pose + config, 1, "/nowhere/run.bag");
  expect_run("localize " + drive->log + " --map /nowhere/map" + to + pose, 1, "/nowhere/map");
  expect_run("localize " + drive->log + map + to + pose + " --config /nowhere/c.yaml", 1,
             "/nowhere/c.yaml");
  expect_run("localize " + drive->log + map + to + " --set relocalization.method=off", 1,
             "--initial-pose");
  expect_run("localize " + drive->log + map + to + pose + " --points /velodyne", 1, "/velodyne");
  expect_run("localize " + drive->log + map + to + pose + " --imu /mems", 1, "/mems");
  EXPECT_TRUE(out.names().empty());
}

TEST_F(LocalizeCommand, AnUnknownTopicIsAnErrorThatListsThoseThereAre) {
  const auto run = expect_run(drive->localize(out / "run", "--points /velodyne"), 1, "/velodyne");
  EXPECT_THAT(run.out, HasSubstr("/points"));
  const auto imu = expect_run(drive->localize(out / "run", "--imu /mems"), 1, "/mems");
  EXPECT_THAT(imu.out, HasSubstr("/imu"));
}

TEST_F(LocalizeCommand, AMissingExtrinsicNamesItsKey) {
  fs::copy_file(drive->log, out / "run.bag");  // no config.yaml beside it
  const std::string arguments = "localize " + out / "run.bag" + " --map " + drive->map + " --out " +
                                out / "run" + " --initial-pose \"" + drive->pose + "\"";
  expect_run(arguments, 1, "T_body_lidar");
  EXPECT_THAT(out.names(), ElementsAre("run.bag"));
  expect_run(arguments + " --set \"T_body_lidar=[0.1, 0, 0.15, 0, 0, 0, 1]\" --no-report", 0);
}

TEST_F(LocalizeCommand, ABadPoseIsWrongUsageAndSaysWhatIsBad) {
  const auto with_pose = [&](const std::string& pose) {
    return "localize " + drive->log + " --map " + drive->map + " --out " + out / "run" +
           " --initial-pose \"" + pose + "\"";
  };
  expect_run(with_pose("1 2 3"), 2, "7 numbers");
  expect_run(with_pose("1 2 3 0 0 0 1 4"), 2, "has 8");
  expect_run(with_pose("1 2 three 0 0 0 1"), 2, "'three' is not a number");
  expect_run(with_pose("1 2 nan 0 0 0 1"), 2, "'nan'");
  expect_run(with_pose("1 2 3 0 0 0 0"), 2, "norm 0.000");
  expect_run(with_pose("1 2 3 1 1 1 1"), 2, "norm 2.000");
  EXPECT_TRUE(out.names().empty());
}

TEST_F(LocalizeCommand, CommasInAPoseAreAllowed) {
  std::string pose = drive->pose;
  std::replace(pose.begin(), pose.end(), ' ', ',');
  expect_run("localize " + drive->log + " --map " + drive->map + " --out " + out / "run" +
                 " --no-report --initial-pose \"" + pose + "\"",
             0);
}

TEST_F(LocalizeCommand, AnUnknownKeyNamesTheNearestOne) {
  expect_run(drive->localize(out / "run", "--set map_filter.robust_scal=2"), 1,
             "map_filter.robust_scale");
  expect_run(drive->localize(out / "run", "--set start.position_m=-3"), 1, "start.position_m");
  expect_run(drive->localize(out / "run", "--set nonsense"), 1, "nonsense");
  put(out / "c.yaml", "T_body_lidar: [0, 0, 0, 0, 0, 0, 1]\nmap_filtre:\n  gate_m: 1\n");
  const auto run =
      expect_run(drive->localize(out / "run", "--config " + out / "c.yaml"), 1, out / "c.yaml");
  EXPECT_THAT(run.out, HasSubstr("map_filter"));
  EXPECT_THAT(out.names(), ElementsAre("c.yaml"));
}

TEST_F(LocalizeCommand, AnUnknownMethodIsWrongUsage) {
  expect_run(drive->localize(out / "run", "--method magic"), 2, "map_filter");
  EXPECT_TRUE(out.names().empty());
}

TEST_F(LocalizeCommand, WhatIsNoBagIsAnErrorThatNamesTheFile) {
  put(out / "text.bag", "#ROSBAG V9.0\nnot really");
  put(out / "empty.bag", "");
  put(out / "cloud.pcd", "# .PCD v0.7\n");
  for (const char* name : {"text.bag", "empty.bag", "cloud.pcd"}) {
    const std::string log = out / name;
    expect_run("localize " + log + " --map " + drive->map + " --out " + out / "run" + " --config " +
                   drive->sim + "/config.yaml --initial-pose \"" + drive->pose + "\"",
               1, log);
  }
  EXPECT_EQ(out.names().size(), 3U);
}

TEST_F(LocalizeCommand, ATruncatedBagIsUsedAsFarAsItGoes) {
  std::string bag = content(drive->log);
  put(out / "cut.bag", bag.substr(0, bag.size() * 6 / 10));
  expect_run("localize " + out / "cut.bag" + " --map " + drive->map + " --out " + out / "run" +
                 " --no-report --config " + drive->sim + "/config.yaml --initial-pose \"" +
                 drive->pose + "\"",
             0);
  const auto summary = nlohmann::json::parse(content(out / "run/summary.json"));
  EXPECT_EQ(summary["counters"]["truncated"], 1);
  EXPECT_GT(summary["scans"], 5);
  EXPECT_THAT(summary["warnings"].dump(), HasSubstr("ends early"));
}

TEST_F(LocalizeCommand, ADamagedMapIsAnErrorThatNamesTheFile) {
  const std::string map = out / "map";
  fs::copy(drive->map, map, fs::copy_options::recursive);
  const std::string yaml = content(map + "/map.yaml");
  const auto arguments = "localize " + drive->log + " --map " + map + " --out " + out / "run" +
                         " --initial-pose \"" + drive->pose + "\"";
  std::string newer = yaml;
  newer.replace(newer.find("format_version: 2"), 17, "format_version: 9");
  put(map + "/map.yaml", newer);
  expect_run(arguments, 1, "format_version 9");
  put(map + "/map.yaml", yaml.substr(0, yaml.size() / 2));
  expect_run(arguments, 1, map);
  put(map + "/map.yaml", yaml);
  for (const auto& tile : fs::directory_iterator(map + "/tiles")) {
    if (tile.path().extension() == ".tile") fs::resize_file(tile.path(), 100);
  }
  expect_run(arguments, 1, ".tile");
  EXPECT_THAT(out.names(), ElementsAre("map"));
}

TEST_F(LocalizeCommand, AFolderThatIsNotARunIsRefusedAndARunIsReplaced) {
  fs::create_directories(out / "photos");
  put(out / "photos/sea.jpg", "blue");
  expect_run(drive->localize(out / "photos"), 1, out / "photos");
  EXPECT_EQ(content(out / "photos/sea.jpg"), "blue");
  put(out / "file", "text");
  expect_run(drive->localize(out / "file"), 1, out / "file");
  EXPECT_EQ(content(out / "file"), "text");
  expect_run(drive->localize(out / "run", "--no-report"), 0);
  put(out / "run/old", "from before");
  expect_run(drive->localize(out / "run", "--no-report"), 0);
  EXPECT_FALSE(fs::exists(out / "run/old"));
  EXPECT_THAT(out.names(), ElementsAre("file", "photos", "run"));
}

TEST_F(LocalizeCommand, APoseFarOffClaimsNothingAndStillWritesTheRun) {
  expect_run("localize " + drive->log + " --map " + drive->map + " --out " + out / "run" +
                 " --no-report --initial-pose \"500 500 0 0 0 0 1\"",
             0);
  EXPECT_EQ(content(out / "run/trajectory.tum"), "");
  EXPECT_THAT(content(out / "run/steps.csv"), HasSubstr("INITIALIZING"));
}

TEST_F(LocalizeCommand, ProgressIsPlainLinesWithoutATerminal) {
  const auto run = expect_run(drive->localize(out / "run", "--no-report"), 0);
  EXPECT_THAT(run.out, Not(HasSubstr("\r")));
  EXPECT_THAT(run.out, Not(HasSubstr("\x1b")));
}

}  // namespace
}  // namespace holdfast::testing
