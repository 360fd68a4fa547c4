#include <gtest/gtest.h>

#include <filesystem>

#include "tests/interface/program.hpp"

namespace holdfast::testing {
namespace {

/// The contract: 0 done, 1 could not do it, 2 wrong usage.
void expect_run(const std::string& arguments, int exit_code, const std::string& says) {
  const ProgramRun run = run_program(arguments);
  EXPECT_EQ(run.exit_code, exit_code) << arguments << "\n" << run.out;
  EXPECT_NE(run.out.find(says), std::string::npos) << arguments << "\n" << run.out;
}

TEST(Program, HelpOfEveryCommandIsPrinted) {
  expect_run("--help", 0, "localize");
  for (const char* command : {"simulate", "map", "map import", "map build", "map info",
                              "map export", "localize", "evaluate", "config"}) {
    expect_run(std::string(command) + " --help", 0, "Usage: holdfast " + std::string(command));
  }
}

TEST(Program, WrongUsageIsExitCodeTwo) {
  for (const char* arguments : {"", "fly", "map", "map fly", "localize", "evaluate", "simulate",
                                "localize --unknown-option", "config default --unknown-option"}) {
    expect_run(arguments, 2, "");
  }
}

TEST(Program, WhatCannotBeReadIsExitCodeOneAndNamed) {
  expect_run("map info /nonexistent-map", 1, "/nonexistent-map");
  expect_run("map import /nonexistent.pcd --out /nonexistent-map", 1, "/nonexistent.pcd");
  expect_run("evaluate /nonexistent.tum --truth /nonexistent.tum", 1, "/nonexistent.tum");
}

TEST(Program, AMissingExtrinsicIsNamedAndNothingIsWritten) {
  const auto run = std::filesystem::path(::testing::TempDir()) /
                   ("holdfast_no_extrinsic_" + std::to_string(getpid()));
  expect_run("localize /nonexistent.bag --map /nonexistent-map --out " + run.string(), 1,
             "T_body_lidar");
  EXPECT_FALSE(std::filesystem::exists(run));
}

TEST(Program, AMisspelledKeyNamesTheNearestOne) {
  expect_run(
      "localize /nonexistent.bag --map /nonexistent-map --out /nonexistent-run "
      "--set map_filter.gate=1",
      1, "the nearest known key is 'map_filter.gate_m'");
}

}  // namespace
}  // namespace holdfast::testing
