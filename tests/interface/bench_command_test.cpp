#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/interface/program.hpp"

namespace holdfast::testing {
namespace {

/// A folder of the test that runs: others may run beside it.
std::string scratch() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  return (std::filesystem::temp_directory_path() / "holdfast_bench_command_test").string() + "_" +
         test->name();
}

TEST(BenchCommand, WritesTheTableThatItPrints) {
  const auto run = run_program("bench simulator --duration 1 --threads 1 --out " + scratch());
  EXPECT_EQ(run.exit_code, 0) << run.out;
  EXPECT_NE(run.out.find("| corridor "), std::string::npos) << run.out;
  EXPECT_TRUE(std::filesystem::exists(scratch() + "/simulator.json"));
  EXPECT_TRUE(std::filesystem::exists(scratch() + "/simulator.md"));
  std::filesystem::remove_all(scratch());
}

TEST(BenchCommand, DetectionJudgesBothDetectorsOnTheSameDrives) {
  const auto run =
      run_program("bench detection --scenario office --duration 10 --seeds 1:1 --out " + scratch());
  EXPECT_EQ(run.exit_code, 0) << run.out;
  for (const char* row :
       {"| quiet, evidence ", "| kidnap, evidence ", "| kidnap, dual index ",
        "| evidence, p >= 0.5 ", "| dual index, alpha 2, d_th 0.5 m ", "| 0.9 to 1 "}) {
    EXPECT_NE(run.out.find(row), std::string::npos) << row << " in\n" << run.out;
  }
  EXPECT_TRUE(std::filesystem::exists(scratch() + "/detection.json"));
  std::filesystem::remove_all(scratch());
}

TEST(BenchCommand, RelocalizationTakesTheRobotAwayAndSwitchesItOn) {
  const auto run = run_program(
      "bench relocalization --scenario office --duration 12 --seeds 1:1 --out " + scratch());
  EXPECT_EQ(run.exit_code, 0) << run.out;
  EXPECT_NE(run.out.find("| kidnap, as surveyed"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("| start, 20 % changed"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("Not driven"), std::string::npos) << run.out;
}

TEST(BenchCommand, NamesTheBenchesWhenAskedForAnotherOne) {
  const auto run = run_program("bench speed --out " + scratch());
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(
      run.out.find("step, accuracy, scenarios, detection, relocalization, search, regions, import"),
      std::string::npos)
      << run.out;
  EXPECT_FALSE(std::filesystem::exists(scratch()));
}

TEST(BenchCommand, TakesSettingsWhereTheSystemRuns) {
  const auto unknown = run_program("bench accuracy --set map_filter.gate=1 --out " + scratch());
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_NE(unknown.out.find("map_filter.gate_m"), std::string::npos) << unknown.out;
  const auto useless = run_program("bench simulator --set method=graph --out " + scratch());
  EXPECT_EQ(useless.exit_code, 1);
  EXPECT_NE(useless.out.find("takes no --set"), std::string::npos) << useless.out;
  EXPECT_FALSE(std::filesystem::exists(scratch()));
}

TEST(BenchCommand, GoesOnWhereAStoppedRunOfAllScenariosWas) {
  const std::string command =
      "bench scenarios --scenario box --seeds 1 --duration 6 --out " + scratch();
  const auto run = run_program(command);
  EXPECT_EQ(run.exit_code, 0) << run.out;
  for (const char* row : {"| box, nominal", "| box, changed", "| box, kidnap", "| box, blind"}) {
    EXPECT_NE(run.out.find(row), std::string::npos) << run.out;
  }
  // As if stopped after the first drive.
  const std::filesystem::path file = scratch() + "/scenarios.drives.jsonl";
  std::string terms, first;
  {
    std::ifstream in(file);
    std::getline(in, terms);
    std::getline(in, first);
  }
  EXPECT_NE(first.find("box nominal 1"), std::string::npos);
  std::ofstream(file) << terms << "\n" << first << "\n";
  const auto again = run_program(command);
  EXPECT_EQ(again.exit_code, 0) << again.out;
  EXPECT_NE(again.out.find("| box, nominal"), std::string::npos) << again.out;
  const auto other = run_program(command + " --set method=map_filter");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.out.find("choose another folder"), std::string::npos) << other.out;
  std::filesystem::remove_all(scratch());
}

TEST(BenchCommand, RefusesScenariosThatThereAreNot) {
  const auto unknown = run_program("bench scenarios --scenario cellar --out " + scratch());
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_NE(unknown.out.find("known are: corridor"), std::string::npos) << unknown.out;
  const auto useless = run_program("bench step --scenario hall --out " + scratch());
  EXPECT_EQ(useless.exit_code, 1);
  EXPECT_NE(useless.out.find("takes no --scenario"), std::string::npos) << useless.out;
}

TEST(BenchCommand, RefusesSeedsOfAnotherForm) {
  const auto run = run_program("bench step --seeds ten --out " + scratch());
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.out.find("'ten'"), std::string::npos) << run.out;
}

}  // namespace
}  // namespace holdfast::testing
