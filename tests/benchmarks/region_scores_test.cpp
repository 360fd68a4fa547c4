#include "benchmarks/scores/region_scores.hpp"

#include <gtest/gtest.h>

namespace holdfast::benchmarks {
namespace {

simulation::Region region(const char* name, double from_x, double to_x) {
  simulation::Region r;
  r.name = name;
  r.min = {from_x, -1};
  r.max = {to_x, 1};
  return r;
}

/// A scan at x metres along a straight way, off by 10 mm for each metre.
evaluation::ScanRecord scan_at(double x) {
  evaluation::ScanRecord scan;
  scan.claimed = scan.counts = true;
  scan.status = "TRACKING";
  scan.truth.kind = evaluation::TruthSample::Kind::kKnown;
  scan.truth.T_map_body.translation = {x, 0, 0.4};
  scan.truth.path_m = x;
  scan.trans_error_m = scan.undeclared_error_m = 0.01 * x;
  scan.rot_error_deg = 0;
  return scan;
}

/// Scans at 0, 1, ... 9 m; "lane" holds 2 to 4, "plaza" 4 to 6.
std::vector<RegionScore> scores_of(const std::vector<evaluation::ScanRecord>& series) {
  return score_regions({region("lane", 1.5, 4.5), region("plaza", 3.5, 6.5)}, series);
}

std::vector<evaluation::ScanRecord> straight_way() {
  std::vector<evaluation::ScanRecord> series;
  for (int x = 0; x < 10; ++x) series.push_back(scan_at(x));
  return series;
}

TEST(RegionScores, TakeEachScanOnceAndAllInTheLast) {
  const auto scores = scores_of(straight_way());
  ASSERT_EQ(scores.size(), 4U);
  EXPECT_EQ(scores[0].name, "lane");
  EXPECT_EQ(scores[0].trans_m, (std::vector{0.01 * 2, 0.01 * 3, 0.01 * 4}));
  EXPECT_EQ(scores[1].trans_m, (std::vector{0.01 * 5, 0.01 * 6})) << "4 m is the lane's";
  EXPECT_EQ(scores[2].name, "elsewhere");
  EXPECT_EQ(scores[2].scans, 5U);
  EXPECT_EQ(scores[3].name, "whole drive");
  EXPECT_EQ(scores[3].scans, 10U);
  EXPECT_DOUBLE_EQ(scores[0].path_m, 3);
  EXPECT_DOUBLE_EQ(scores[3].path_m, 9);
}

TEST(RegionScores, ScansWithoutAClaimAreNotTrustedAndHaveNoError) {
  auto series = straight_way();
  series[3].claimed = false;
  series[3].status = "LOST";
  const auto scores = scores_of(series);
  EXPECT_EQ(scores[0].trans_m.size(), 2U);
  EXPECT_EQ(scores[0].trusted.count, 2U);
  EXPECT_EQ(scores[0].trusted.of, 3U);
  EXPECT_EQ(scores[1].trusted.value(), 1);
}

TEST(RegionScores, LeaveOutWhatSharesLeaveOut) {
  auto series = straight_way();
  series[2].counts = false;
  const auto scores = scores_of(series);
  EXPECT_EQ(scores[0].scans, 2U);
  EXPECT_EQ(scores[3].scans, 9U);
}

TEST(RegionScores, CountTrustedScansThatAreFarOff) {
  auto series = straight_way();
  series[5].trans_error_m = series[5].undeclared_error_m = 0.6;
  EXPECT_EQ(scores_of(series)[1].misleading.count, 1U);
  series[5].status = "SUSPECT";
  EXPECT_EQ(scores_of(series)[1].misleading.count, 0U);
}

}  // namespace
}  // namespace holdfast::benchmarks
