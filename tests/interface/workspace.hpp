#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/interface/program.hpp"

/// What tests of the program share: a folder of their own, and a simulated drive with its map.
namespace holdfast::testing {

namespace fs = std::filesystem;

inline std::string content(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

inline void put(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// A new folder, removed with what is in it.
class Workspace {
 public:
  Workspace() {
    std::string name = (fs::temp_directory_path() / "holdfast_program_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) std::abort();
    path_ = name;
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
  ~Workspace() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }

  const fs::path& path() const { return path_; }
  /// Path of something in the folder, as text for a command line.
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

  /// Names of what is in the folder, hidden and half-written things too.
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path_)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  fs::path path_;
};

/// Runs the program and expects how it ends and what it says.
inline ProgramRun expect_run(const std::string& arguments, int exit_code,
                             const std::string& says = "") {
  ProgramRun run = run_program(arguments);
  EXPECT_EQ(run.exit_code, exit_code) << "holdfast " << arguments << "\n" << run.out;
  EXPECT_THAT(run.out, ::testing::HasSubstr(says)) << "holdfast " << arguments;
  return run;
}

/// A drive of 2.5 s through the office with its map, made by the program.
struct SmallDrive {
  Workspace files;
  std::string sim = files / "sim";
  std::string log = files / "sim/run.bag";
  std::string map = files / "map";
  std::string pose;  ///< "x y z qx qy qz qw" at the first scan

  SmallDrive() {
    expect_run("simulate office --seed 3 --duration 2.5 --out " + sim, 0, "--initial-pose");
    expect_run("map import " + sim + "/map.pcd --out " + map, 0, "identity");
    const std::string mark = "# initial_pose: ";
    for (const std::string& line : lines_of(content(sim + "/config.yaml"))) {
      if (line.find(mark) == 0) pose = line.substr(mark.size());
    }
    EXPECT_FALSE(pose.empty());
  }

  /// The command line that localizes the drive into `out`.
  std::string localize(const std::string& out, const std::string& more = "") const {
    return "localize " + log + " --map " + map + " --out " + out + " --initial-pose \"" + pose +
           "\" " + more;
  }
};

}  // namespace holdfast::testing
