#include <nlohmann/json.hpp>

#include "tests/interface/workspace.hpp"

/// Commands other than localize.
namespace holdfast::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Command {
  const char* name;
  std::vector<const char*> options;
};

class Help : public ::testing::TestWithParam<Command> {};

TEST_P(Help, MentionsEveryOption) {
  const auto run = expect_run(std::string(GetParam().name) + " --help", 0);
  for (const char* option : GetParam().options) EXPECT_THAT(run.out, HasSubstr(option));
}

#define HOLDFAST_RUN_OPTIONS \
  "--config", "--set", "--points", "--imu", "--scans", "START:STOP:STEP", "--threads"
INSTANTIATE_TEST_SUITE_P(
    Of, Help,
    ::testing::Values(
        Command{"", {"simulate", "map", "localize", "evaluate", "config", "--help"}},
        Command{"simulate", {"SCENARIO", "--out", "--seed", "--duration", "--event", "--threads"}},
        Command{"map", {"import", "build", "info", "export"}},
        Command{"map import", {"--out", "--edges", "--planes", "--threads"}},
        Command{"map build", {"logs", "--poses", "--out", HOLDFAST_RUN_OPTIONS}},
        Command{"map info", {"map"}}, Command{"map export", {"map", "--out"}},
        Command{"localize",
                {"log", "--map", "--out", "--initial-pose", "x y z qx qy qz qw", "--method",
                 "--truth", "--no-report", HOLDFAST_RUN_OPTIONS}},
        Command{"evaluate", {"ESTIMATE", "--truth", "--events", "--align", "--json", "--report"}}),
    [](const auto& command) {
      std::string name = *command.param.name == '\0' ? "holdfast" : command.param.name;
      std::replace(name.begin(), name.end(), ' ', '_');
      return name;
    });
#undef HOLDFAST_RUN_OPTIONS

/// A floor and a wall of some hundred points, ascii PCD.
std::string small_cloud() {
  std::string points;
  int count = 0;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) {
      points += std::to_string(0.1 * i) + " " + std::to_string(0.1 * j) + " 0\n";
      points += "0 " + std::to_string(0.1 * j) + " " + std::to_string(0.1 * i) + "\n";
      count += 2;
    }
  }
  const std::string n = std::to_string(count);
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + n +
         "\nHEIGHT 1\nPOINTS " + n + "\nDATA ascii\n" + points;
}

TEST(SimulateCommand, AnUnknownScenarioIsWrongUsageAndListsTheKnownOnes) {
  const Workspace out;
  const auto run = expect_run("simulate moon --out " + out / "sim", 2, "moon");
  for (const char* name : {"corridor", "office", "hall"}) EXPECT_THAT(run.out, HasSubstr(name));
  EXPECT_TRUE(out.names().empty());
  EXPECT_THAT(expect_run("simulate --list", 0).out, HasSubstr("corridor"));
}

TEST(SimulateCommand, ABadEventIsWrongUsageAndShowsTheForm) {
  const Workspace out;
  const std::string to = " --duration 1 --out " + out / "sim";
  for (const char* event : {"earthquake@3", "blind", "blind@", "blind@x", "imu_bias_jump@3+2"}) {
    const auto run = expect_run("simulate office --event " + std::string(event) + to, 2);
    EXPECT_THAT(run.out, HasSubstr(event)) << run.out;
  }
  expect_run("simulate office --event blind@500" + to, 2, "blind");
  expect_run("simulate office --duration 9 --event kidnap@3+1 --out " + out / "sim", 2,
             "expected at least");
  expect_run("simulate office --motion flying" + to, 2, "handheld");
  expect_run("simulate office --duration -1 --out " + out / "sim", 2);
  expect_run("simulate office --duration fast --out " + out / "sim", 2);
  EXPECT_TRUE(out.names().empty());
}

TEST(SimulateCommand, AStrangersFolderIsRefused) {
  const Workspace out;
  put(out / "letter.txt", "dear");
  expect_run("simulate office --duration 0.5 --out " + out.path().string(), 1, out.path().string());
  EXPECT_THAT(out.names(), ElementsAre("letter.txt"));
}

TEST(MapCommand, ImportsChecksAndExportsAMap) {
  const Workspace out;
  put(out / "cloud.pcd", small_cloud());
  const auto made = expect_run("map import " + out / "cloud.pcd" + " --out " + out / "map", 0);
  const auto info = expect_run("map info " + out / "map", 0, "3200");
  for (const char* word : {"identity", "cloud.pcd", "extent", "gravity", "planes", "tiles"}) {
    EXPECT_THAT(made.out, HasSubstr(word));
    EXPECT_THAT(info.out, HasSubstr(word));
  }
  expect_run("map export " + out / "map" + " --out " + out / "back.pcd", 0, "3200 points");
  expect_run("map import " + out / "back.pcd" + " --out " + out / "again", 0);
  expect_run("map export " + out / "map" + " --out " + out / "back.ply", 0);
  EXPECT_THAT(out.names(), ElementsAre("again", "back.pcd", "back.ply", "cloud.pcd", "map"));
}

TEST(MapCommand, WhatCannotBeImportedIsNamedAndLeavesNothing) {
  const Workspace out;
  const std::string to = " --out " + out / "map";
  put(out / "few.pcd",
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
      "POINTS 2\nDATA ascii\n1 2 3\n4 5 6\n");
  put(out / "cut.pcd", small_cloud().substr(0, 400));
  put(out / "cloud.xyz", "1 2 3\n");
  for (const char* name : {"few.pcd", "cut.pcd", "cloud.xyz"}) {
    expect_run("map import " + out / name + to, 1, name);
  }
  expect_run("map import /nowhere/cloud.pcd" + to, 1, "/nowhere/cloud.pcd");
  EXPECT_THAT(out.names(), ElementsAre("cloud.xyz", "cut.pcd", "few.pcd"));
}

TEST(MapCommand, EitherACloudOrBothFeatureCloudsAreExpected) {
  const Workspace out;
  put(out / "cloud.pcd", small_cloud());
  const std::string cloud = out / "cloud.pcd";
  const std::string to = " --out " + out / "map";
  expect_run("map import" + to, 2, "--edges");
  expect_run("map import --edges " + cloud + to, 2, "--planes");
  expect_run("map import " + cloud + " --edges " + cloud + " --planes " + cloud + to, 2, "either");
  expect_run("map import --edges " + cloud + " --planes " + cloud + to, 0);
}

TEST(MapCommand, DamageIsFoundByInfoAndByExport) {
  const Workspace out;
  put(out / "cloud.pcd", small_cloud());
  expect_run("map import " + out / "cloud.pcd" + " --out " + out / "map", 0);
  for (const auto& file : fs::directory_iterator(out / "map/tiles")) {
    if (file.path().extension() != ".points") continue;
    std::string bytes = content(file.path());
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    put(file.path(), bytes);
    expect_run("map info " + out / "map", 1, file.path().filename().string());
    expect_run("map export " + out / "map" + " --out " + out / "x.pcd", 1,
               file.path().filename().string());
  }
  EXPECT_THAT(out.names(), ElementsAre("cloud.pcd", "map"));
}

TEST(MapCommand, AFolderOfSomethingElseIsNoMapAndIsNotReplaced) {
  const Workspace out;
  put(out / "cloud.pcd", small_cloud());
  expect_run("map info " + out.path().string(), 1, "map.yaml");
  expect_run("map import " + out / "cloud.pcd" + " --out " + out.path().string(), 1,
             out.path().string());
  EXPECT_THAT(out.names(), ElementsAre("cloud.pcd"));
}

TEST(MapCommand, BuildNeedsPosesThatCoverTheLog) {
  const Workspace out;
  expect_run("simulate office --duration 1 --out " + out / "sim", 0);
  const std::string build = "map build " + out / "sim/run.bag" + " --out " + out / "map";
  expect_run(build, 1, "--poses");
  expect_run(build + " --poses /nowhere/truth.tum", 1, "/nowhere/truth.tum");
  put(out / "other.tum", "1.0 0 0 0 0 0 0 1\n2.0 0 0 0 0 0 0 1\n");
  expect_run(build + " --poses " + out / "other.tum", 1, "other.tum");
  EXPECT_FALSE(fs::exists(out / "map"));
  expect_run(build + " --poses " + out / "sim/truth.tum", 0, "planes");
  expect_run("map info " + out / "map", 0, "run.bag");
}

TEST(EvaluateCommand, WrongUsageAndWhatCannotBeReadAreToldApart) {
  const Workspace out;
  put(out / "a.tum", "1.0 0 0 0 0 0 0 1\n1.1 0.5 0 0 0 0 0 1\n");
  put(out / "bad.tum", "1.0 0 0 zero 0 0 0 1\n");
  put(out / "late.tum", "900.0 0 0 0 0 0 0 1\n901.0 0 0 0 0 0 0 1\n");
  const std::string a = out / "a.tum";
  expect_run("evaluate " + a + " --truth " + a, 0);
  expect_run("evaluate " + a, 2, "--truth");
  expect_run("evaluate " + a + " --truth " + a + " --align sim3", 2, "--align");
  expect_run("evaluate " + out / "bad.tum" + " --truth " + a, 1, "bad.tum");
  expect_run("evaluate " + a + " --truth /nowhere.tum", 1, "/nowhere.tum");
  expect_run("evaluate " + a + " --truth " + out / "late.tum", 1);
  EXPECT_THAT(out.names(), ElementsAre("a.tum", "bad.tum", "late.tum"));
}

}  // namespace
}  // namespace holdfast::testing
