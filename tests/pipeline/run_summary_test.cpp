#include "holdfast/pipeline/run_summary.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace holdfast::pipeline {
namespace {

constexpr TimeNs kStart = 1'700'000'000 * kSecond;

StepReport step(int number, State state, double ms) {
  StepReport r;
  r.stamp = kStart + number * kSecond / 10;
  r.pose_time = r.stamp + kSecond / 10;
  r.state = state;
  r.times.total_ms = ms;
  r.times.wall_ms = 2 * ms;
  r.times.ms[1] = ms / 2;
  return r;
}

nlohmann::json json_of(const RunSummary& summary, const RunSummary::About& about = {}) {
  return nlohmann::json::parse(summary.json(about));
}

TEST(RunSummary, QuantilesAreNearestRanksWhateverTheOrder) {
  RunSummary summary;
  for (int i = 0; i < 200; ++i) summary.add(step(i, State::kTracking, 1 + (i * 37) % 200));
  const auto j = json_of(summary);
  EXPECT_EQ(j["step_ms"]["p50"], 100.0);
  EXPECT_EQ(j["step_ms"]["p95"], 190.0);
  EXPECT_EQ(j["step_ms"]["p99"], 198.0);
  EXPECT_EQ(j["step_ms"]["max"], 200.0);
  EXPECT_EQ(j["step_wall_ms"]["p50"], 200.0);
  EXPECT_EQ(j["stage_p50_ms"][std::string(kStageNames[1])], 50.0);
  EXPECT_EQ(summary.median_step_ms(), 100.0);
}

TEST(RunSummary, OneStepIsEveryQuantile) {
  RunSummary summary;
  summary.add(step(0, State::kTracking, 0.75));
  const auto j = json_of(summary);
  for (const char* name : {"p50", "p95", "p99", "max"}) EXPECT_EQ(j["step_ms"][name], 0.75);
}

TEST(RunSummary, OnlyPosesThatWereTakenOverAreRelocalizations) {
  RunSummary summary;
  summary.add(step(0, State::kTracking, 1));
  for (const bool accepted : {false, true, true}) {
    SearchSummary search;
    search.accepted = accepted;
    StepReport report = step(1, State::kTracking, 1);
    report.search = std::make_shared<const SearchSummary>(search);
    summary.add(report);
  }
  EXPECT_EQ(json_of(summary)["relocalizations"], 2);
}

TEST(RunSummary, SharesOfStatesAddUpToOne) {
  RunSummary summary;
  const State states[] = {State::kInitializing, State::kTracking,     State::kTracking,
                          State::kDegraded,     State::kLost,         State::kTracking,
                          State::kTracking,     State::kDeadReckoning};
  for (int i = 0; i < 8; ++i) summary.add(step(i, states[i], 1));
  const auto share = json_of(summary)["status_share"];
  EXPECT_EQ(share["TRACKING"], 0.5);
  EXPECT_EQ(share["LOST"], 0.125);
  double sum = 0;
  for (const auto& value : share) sum += value.get<double>();
  EXPECT_DOUBLE_EQ(sum, 1.0);
  EXPECT_FALSE(share.contains("SUSPECT"));
  EXPECT_EQ(summary.claimed(), 6U);
  EXPECT_EQ(summary.scans_in(State::kTracking), 4U);
  EXPECT_EQ(json_of(summary)["claimed"], 6);
  EXPECT_EQ(json_of(summary)["scans"], 8);
}

TEST(RunSummary, DurationRunsFromTheFirstPointToTheLast) {
  RunSummary summary;
  for (int i = 0; i < 50; ++i) summary.add(step(i, State::kTracking, 1));
  RunSummary::About about;
  about.elapsed_s = 0.5;
  EXPECT_DOUBLE_EQ(json_of(summary, about)["duration_s"], 5.0);
  EXPECT_DOUBLE_EQ(json_of(summary, about)["realtime_factor"], 10.0);
}

TEST(RunSummary, ScansWithHeldImuAndWhatTheLogSurvivedAreCounted) {
  RunSummary summary;
  StepReport held = step(0, State::kTracking, 1);
  held.imu_held_ns = 1;
  summary.add(held);
  summary.add(step(1, State::kTracking, 1));
  RunSummary::About about;
  about.counters = {{"bad_messages", 3}};
  about.warnings = {"3 messages do not hold together"};
  const auto j = json_of(summary, about);
  EXPECT_EQ(j["counters"]["scans_with_imu_held"], 1);
  EXPECT_EQ(j["counters"]["bad_messages"], 3);
  EXPECT_EQ(j["warnings"].size(), 1U);
}

TEST(RunSummary, AnEmptyRunIsStillWhole) {
  const auto j = json_of(RunSummary{});
  EXPECT_EQ(j["scans"], 0);
  EXPECT_EQ(j["step_ms"]["p50"], 0.0);
  EXPECT_EQ(j["realtime_factor"], 0.0);
}

TEST(RunSummary, MemoryIsThatOfThisProcess) {
  EXPECT_GT(peak_rss_mb(), 1.0);
  EXPECT_LT(peak_rss_mb(), 100'000.0);
  EXPECT_GT(json_of(RunSummary{})["peak_rss_mb"], 1.0);
}

}  // namespace
}  // namespace holdfast::pipeline
