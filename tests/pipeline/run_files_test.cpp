#include "holdfast/pipeline/run_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "holdfast/io/tum_file.hpp"
#include "tests/map/built_map.hpp"

namespace holdfast::pipeline {
namespace {

namespace fs = std::filesystem;
using map::testing::ScratchFolder;

constexpr TimeNs kStart = 1'700'000'000'123'456'789;

std::string read(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

/// Fields of a line of CSV, quotes taken off.
std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> result(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"') {
        result.back() += line[i++];
      } else {
        quoted = !quoted;
      }
    } else if (line[i] == ',' && !quoted) {
      result.emplace_back();
    } else {
      result.back() += line[i];
    }
  }
  return result;
}

StepReport report(int number, State state, const std::string& reason = "") {
  StepReport r;
  r.stamp = kStart + number * kSecond / 10;
  r.pose_time = r.stamp + kSecond / 10 - 1;
  r.state = state;
  r.reason = reason;
  r.T_map_body.translation = {1.0 + number, 2.0, 3.0};
  r.times.total_ms = 0.5;
  return r;
}

std::string value(const StepReport& r, const std::string& column) {
  const auto names = fields(steps_header());
  const auto at = std::find(names.begin(), names.end(), column);
  EXPECT_NE(at, names.end()) << column;
  return fields(format_step(r)).at(static_cast<std::size_t>(at - names.begin()));
}

RunFiles started(const fs::path& path) {
  auto files = RunFiles::create(path);
  if (files) return std::move(*files);
  ADD_FAILURE() << files.error().message;
  std::abort();
}

/// Writes the reports and the marker that a run ends with.
void write_run(const fs::path& path, const std::vector<StepReport>& reports) {
  RunFiles files = started(path);
  for (const StepReport& r : reports) ASSERT_TRUE(files.add(r));
  ASSERT_TRUE(files.close());
  ASSERT_TRUE(files.write("summary.json", "{}\n"));
  ASSERT_TRUE(files.commit());
}

TEST(StepsCsv, HasTheColumnsOfTheContractInTheirOrder) {
  const auto names = fields(steps_header());
  const std::vector<std::string> expected = {"stamp",        "pose_time",         "status",
                                             "reason",       "p_wrong",           "matches",
                                             "inlier_share", "mean_abs_residual", "weak_directions",
                                             "sigma_trans",  "sigma_rot",         "odom_epoch",
                                             "ms_total"};
  ASSERT_GT(names.size(), expected.size());
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), names.begin()));
  for (std::size_t i = expected.size(); i < names.size(); ++i) EXPECT_EQ(names[i].find("ms_"), 0U);
}

TEST(StepsCsv, ARowHasAsManyFieldsAsTheHeader) {
  StepReport r = report(0, State::kTracking);
  EXPECT_EQ(fields(format_step(r)).size(), fields(steps_header()).size());
  r.reason = "a, \"b\", and\nc";
  r.weak_directions = {{1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(fields(format_step(r)).size(), fields(steps_header()).size());
}

TEST(StepsCsv, ValuesStandInTheirColumns) {
  StepReport r = report(3, State::kDegraded, "the scene does not determine every direction");
  r.matches = 1234;
  r.inlier_share = 0.875;
  r.mean_abs_residual_m = 0.0123;
  r.weak_directions = {{1, 0, 0}, {0, -0.6, 0.8}};
  r.sigma_trans_m = 0.0015;
  r.sigma_rot_rad = 0.00025;
  r.odom_epoch = 2;
  r.times.total_ms = 1.25;
  r.times.ms[0] = 0.75;
  EXPECT_EQ(value(r, "stamp"), "1700000000.423456789");
  EXPECT_EQ(value(r, "pose_time"), "1700000000.523456788");
  EXPECT_EQ(value(r, "status"), "DEGRADED");
  EXPECT_EQ(value(r, "reason"), r.reason);
  EXPECT_EQ(value(r, "matches"), "1234");
  EXPECT_EQ(std::stod(value(r, "inlier_share")), 0.875);
  EXPECT_EQ(std::stod(value(r, "mean_abs_residual")), 0.0123);
  EXPECT_EQ(value(r, "weak_directions"), "(1.000 0.000 0.000);(0.000 -0.600 0.800)");
  EXPECT_EQ(std::stod(value(r, "sigma_trans")), 0.0015);
  EXPECT_EQ(std::stod(value(r, "sigma_rot")), 0.00025);
  EXPECT_EQ(value(r, "odom_epoch"), "2");
  EXPECT_EQ(std::stod(value(r, "ms_total")), 1.25);
  EXPECT_EQ(std::stod(value(r, "ms_" + std::string(kStageNames[0]))), 0.75);
}

TEST(StepsCsv, AProbabilityThatIsNotEstimatedIsEmpty) {
  StepReport r = report(0, State::kTracking);
  EXPECT_EQ(value(r, "p_wrong"), "");
  r.p_wrong = 0.0;
  EXPECT_EQ(value(r, "p_wrong"), "0");
  r.p_wrong = 0.25;
  EXPECT_EQ(value(r, "p_wrong"), "0.25");
}

TEST(StepsCsv, AReasonWithCommasAndQuotesIsOneField) {
  for (const char* reason : {"plain", "a, b", "the \"map\"", "two\nlines", ",", "\"", ""}) {
    EXPECT_EQ(value(report(0, State::kLost, reason), "reason"), reason);
  }
}

TEST(RunFiles, TheTrajectoryHoldsClaimsOnlyAndStepsEveryScan) {
  const ScratchFolder folder;
  const fs::path run = folder.path() / "run";
  std::vector<StepReport> reports;
  const State states[] = {State::kInitializing,  State::kTracking,    State::kDegraded,
                          State::kDeadReckoning, State::kUnmapped,    State::kSuspect,
                          State::kLost,          State::kRelocalizing};
  for (int i = 0; i < 8; ++i) reports.push_back(report(i, states[i]));
  write_run(run, reports);
  const auto trajectory = io::read_tum(run / "trajectory.tum");
  ASSERT_TRUE(trajectory) << trajectory.error().message;
  ASSERT_EQ(trajectory->size(), 5U);
  for (int i = 0; i < 5; ++i) {
    const StampedPose& pose = (*trajectory)[static_cast<std::size_t>(i)];
    EXPECT_EQ(pose.t, reports[static_cast<std::size_t>(i + 1)].pose_time);
    EXPECT_EQ(pose.T_map_body.translation.x(), 2.0 + i);
  }
  const auto steps = lines(read(run / "steps.csv"));
  ASSERT_EQ(steps.size(), 9U);
  EXPECT_EQ(steps[0], steps_header());
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(steps[i + 1], format_step(reports[i]));
}

TEST(RunFiles, EventsAreWrittenWhenTheStateChangesOnly) {
  const ScratchFolder folder;
  const fs::path run = folder.path() / "run";
  write_run(run, {report(0, State::kInitializing, "first"), report(1, State::kInitializing),
                  report(2, State::kTracking), report(3, State::kTracking, "another reason"),
                  report(4, State::kDeadReckoning, "no \"returns\""), report(5, State::kTracking)});
  const auto events = lines(read(run / "events.jsonl"));
  ASSERT_EQ(events.size(), 4U);
  const char* from[] = {"", "INITIALIZING", "TRACKING", "DEAD_RECKONING"};
  const char* to[] = {"INITIALIZING", "TRACKING", "DEAD_RECKONING", "TRACKING"};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto event = nlohmann::json::parse(events[i]);
    EXPECT_EQ(event["event"], "status");
    EXPECT_EQ(event["from"], from[i]);
    EXPECT_EQ(event["to"], to[i]);
  }
  EXPECT_EQ(nlohmann::json::parse(events[2])["reason"], "no \"returns\"");
  // All nine decimals, which a double would not keep.
  EXPECT_EQ(events[0].find("{\"t\":1700000000.223456788,"), 0U) << events[0];
}

TEST(RunFiles, AnAlarmIsWrittenOnceWithItsEvidence) {
  const ScratchFolder folder;
  const fs::path run = folder.path() / "run";
  StepReport alarm = report(1, State::kSuspect, "the pose may be wrong");
  alarm.alarm = true;
  alarm.p_wrong = 0.25;
  alarm.evidence = {{"through", 2.5, "rays through walls of the map: 31 %, usually 2 %"},
                    {"way", -0.5, "..."}};
  StepReport later = alarm;
  later.pose_time += kSecond / 10;
  write_run(run, {report(0, State::kTracking), alarm, later});
  const auto events = lines(read(run / "events.jsonl"));
  ASSERT_EQ(events.size(), 3U);
  const auto event = nlohmann::json::parse(events[2]);
  EXPECT_EQ(event["event"], "alarm");
  EXPECT_EQ(event["reason"], "the pose may be wrong");
  EXPECT_EQ(event["p_wrong"], 0.25);
  ASSERT_EQ(event["evidence"].size(), 2U);
  EXPECT_EQ(event["evidence"][0]["witness"], "through");
  EXPECT_EQ(event["evidence"][0]["log_ratio"], 2.5);
}

TEST(RunFiles, ASearchIsWrittenWithItsCandidatesAndWhatCameOfIt) {
  const ScratchFolder folder;
  const fs::path run = folder.path() / "run";
  SearchSummary search;
  search.t = report(0, State::kLost).pose_time;
  search.outcome = "found";
  search.reason = "one pose explains what is seen";
  search.candidates = {{{}, 0.75, 0.5, 0.999}, {{}, 0.7, 0.25, 0.001}};
  search.candidates[0].T_map_body.translation = {1.5, 2.5, 3.5};
  search.accepted = true;
  StepReport found = report(2, State::kTracking);
  found.search = std::make_shared<const SearchSummary>(search);
  write_run(run, {report(0, State::kLost), report(1, State::kRelocalizing), found});
  const auto events = lines(read(run / "events.jsonl"));
  ASSERT_EQ(events.size(), 5U);  // three states, and two of the search
  const auto told = nlohmann::json::parse(events[3]);
  EXPECT_EQ(told["event"], "search");
  EXPECT_EQ(told["outcome"], "found");
  EXPECT_NEAR(told["began_s_ago"].get<double>(), 0.2, 1e-9);
  ASSERT_EQ(told["candidates"].size(), 2U);
  EXPECT_EQ(told["candidates"][0]["pose"], (std::vector<double>{1.5, 2.5, 3.5, 0, 0, 0, 1}));
  EXPECT_EQ(told["candidates"][1]["probability"], 0.001);
  EXPECT_EQ(nlohmann::json::parse(events[4])["event"], "relocalized");
}

TEST(RunFiles, WithoutACommitNothingIsLeft) {
  const ScratchFolder folder;
  {
    RunFiles files = started(folder.path() / "run");
    ASSERT_TRUE(files.add(report(0, State::kTracking)));
    EXPECT_TRUE(fs::exists(files.staging() / "steps.csv"));
    EXPECT_FALSE(fs::exists(folder.path() / "run"));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(RunFiles, AnOlderRunIsReplacedAndAStrangersFolderIsRefused) {
  const ScratchFolder folder;
  const fs::path run = folder.path() / "run";
  write_run(run, {report(0, State::kTracking), report(1, State::kTracking)});
  write_run(run, {report(0, State::kTracking)});
  EXPECT_EQ(lines(read(run / "steps.csv")).size(), 2U);
  const fs::path other = folder.path() / "photos";
  fs::create_directories(other);
  std::ofstream(other / "holiday.jpg") << "sea";
  const auto refused = RunFiles::create(other);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find(other.string()), std::string::npos);
  EXPECT_EQ(read(other / "holiday.jpg"), "sea");
}

}  // namespace
}  // namespace holdfast::pipeline
