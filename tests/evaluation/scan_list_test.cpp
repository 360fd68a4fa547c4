#include "evaluation/scan_list.hpp"

#include "tests/evaluation/scenes.hpp"

namespace holdfast::evaluation::testing {
namespace {

TEST(ScanList, OfAnEstimateOverTheWholeTruthIsTheEstimate) {
  const Trajectory estimate = sample(0.1, 10, 10, straight);
  const ScanList list = scans_from_period(estimate, TruthTrack(truth_of(10, straight)));
  EXPECT_EQ(list.scans.size(), estimate.size());
  EXPECT_NEAR(list.period_s, 0.1, 1e-9);
}

TEST(ScanList, ToleratesTheJitterOfScans) {
  Trajectory estimate = sample(0.1, 10, 10, straight);
  for (std::size_t i = 0; i < estimate.size(); ++i)
    estimate[i].t += static_cast<TimeNs>(i * 7919 % 5) * kSecond / 1000;
  EXPECT_EQ(scans_from_period(estimate, TruthTrack(truth_of(10.005, straight))).scans.size(),
            estimate.size());
}

TEST(ScanList, AHoleOfTwoScansIsTwoScansWithoutAClaimAtTheirTimes) {
  const auto kept = [](double t) { return t < 4.95 || t > 5.15; };
  const ScanList list = scans_from_period(only(sample(0.1, 10, 10, straight), kept),
                                          TruthTrack(truth_of(10, straight)));
  ASSERT_EQ(list.scans.size(), 100U);
  EXPECT_FALSE(list.scans[49].claimed);
  EXPECT_NEAR(to_seconds(list.scans[49].t), 5.0, 1e-6);
  EXPECT_FALSE(list.scans[50].claimed);
  EXPECT_NEAR(to_seconds(list.scans[50].t), 5.1, 1e-6);
}

TEST(ScanList, OfNothingIsTheTruthAtTheNominalPeriodWithoutClaims) {
  const ScanList list = scans_from_period({}, TruthTrack(truth_of(10, straight)));
  EXPECT_EQ(list.scans.size(), 100U);
  for (const ScanRecord& scan : list.scans) EXPECT_FALSE(scan.claimed);
}

TEST(ScanList, ClaimsFindTheirRowsAndOthersAreScansOfTheirOwn) {
  Trajectory estimate = sample(0.1, 1, 10, straight);
  for (StampedPose& p : estimate) p.t += 400;  // times rounded to a microsecond
  estimate.push_back({from_seconds(1.05), pose(0)});
  const std::vector<StepRow> rows = steps(0.1, 2, [](double) { return "DEGRADED"; });
  const ScanList list = scans_from_steps(estimate, rows, false, TruthTrack({}));
  EXPECT_TRUE(list.from_steps);
  EXPECT_EQ(list.scans.size(), 21U);
  EXPECT_EQ(list.claims_without_row, 1U);
  EXPECT_EQ(list.scans[0].row, 0);
  EXPECT_EQ(list.scans[0].status, "DEGRADED");
  EXPECT_TRUE(list.scans[0].claimed);
  EXPECT_EQ(list.scans[10].row, -1);
  EXPECT_EQ(list.scans[10].status, "TRACKING");
  EXPECT_FALSE(list.scans[11].claimed);
}

}  // namespace
}  // namespace holdfast::evaluation::testing
