#include "evaluation/evaluate.hpp"

#include <gmock/gmock.h>

#include "tests/evaluation/scenes.hpp"

namespace holdfast::evaluation::testing {
namespace {

using ::testing::HasSubstr;

/// Claims at 10 Hz from 0.1 s on: `error` applied on the left of the truth.
Trajectory claims_of(double end, const std::function<SE3(double)>& where, const SE3& error = {}) {
  return sample(0.1, end, 10, [&](double t) { return error * where(t); });
}

Evaluation judged(const Trajectory& estimate, const Trajectory& truth,
                  const RunContext& context = {}, const EvaluationOptions& options = {}) {
  Result<Evaluation> result = evaluate(estimate, truth, options, context);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
  return result.ok() ? std::move(*result) : Evaluation{};
}

TEST(Evaluate, APerfectEstimateHasNoError) {
  const Evaluation e = judged(claims_of(20, circle), truth_of(20, circle));
  // Between two lines at 200 Hz the chord of a 10 m circle is 0.8 um off at most; scans fall on
  // them.
  EXPECT_NEAR(e.trans_m.max, 0, kPositionRounding);
  EXPECT_NEAR(e.rot_deg.max, 0, 1e-5);  // 2 asin(eps^0.5) of the quaternions' rounding
  EXPECT_EQ(e.judged, 200U);
  EXPECT_EQ(e.outside_truth, 0U);
  EXPECT_DOUBLE_EQ(e.coverage.value(), 1);
  EXPECT_DOUBLE_EQ(e.success.value(), 1);
  EXPECT_EQ(e.misleading.count, 0U);
  ASSERT_TRUE(e.e2e_m);
  EXPECT_NEAR(*e.e2e_m, 0, kPositionRounding);
}

TEST(Evaluate, AConstantOffsetIsEveryStatistic) {
  const Evaluation e = judged(claims_of(20, straight, pose(0.03, 0.04)), truth_of(20, straight));
  for (const double value :
       {e.trans_m.rmse, e.trans_m.mean, e.trans_m.median, e.trans_m.p95, e.trans_m.max, *e.e2e_m})
    EXPECT_NEAR(value, 0.05, kPositionRounding);
}

TEST(Evaluate, APureRotationIsAnAngleAndNoDistance) {
  const auto turned = [](double t) { return straight(t) * pose(0, 0, 0, 2 * kDegree); };
  const Evaluation e = judged(claims_of(20, turned), truth_of(20, straight));
  EXPECT_NEAR(e.trans_m.max, 0, kPositionRounding);
  EXPECT_NEAR(e.rot_deg.rmse, 2, kAngleRounding);
  EXPECT_NEAR(e.rot_deg.max, 2, kAngleRounding);
}

TEST(Evaluate, PosesBetweenLinesOfTheTruthAreComparedWithTheInterpolatedPose) {
  const Trajectory estimate = sample(0.1025, 9.9, 10, straight);
  const Evaluation e = judged(estimate, truth_of(10, straight));
  EXPECT_NEAR(e.trans_m.max, 0, kPositionRounding);
}

TEST(Evaluate, ClaimsOutsideTheTruthAreCountedApart) {
  const Evaluation e = judged(claims_of(12, straight), truth_of(10, straight));
  EXPECT_EQ(e.claimed, 120U);
  EXPECT_EQ(e.outside_truth, 20U);
  EXPECT_EQ(e.judged, 100U);
  EXPECT_NEAR(*e.e2e_m, 0, kPositionRounding) << "the last scan with truth";
}

TEST(Evaluate, ClaimsInAGapOfTheTruthAreCountedApart) {
  Trajectory truth = only(truth_of(10, straight), [](double t) { return t < 4 || t > 5; });
  const Evaluation e = judged(claims_of(10, straight, pose(0.01)), truth);
  EXPECT_EQ(e.in_truth_gap, 11U);
  EXPECT_NEAR(e.trans_m.max, 0.01, kPositionRounding);
}

TEST(Evaluate, AfterATeleportTheTruthIsThePlaceItJumpedTo) {
  Trajectory truth = sample(0, 5, 200, straight);
  const auto moved = [](double t) { return pose(t + 40, 10); };
  const Trajectory after = sample(5, 10, 200, moved);
  truth.insert(truth.end(), after.begin(), after.end());
  const auto where = [&](double t) { return t < 4.999 ? straight(t) : moved(t); };
  const Evaluation e = judged(claims_of(10, where), truth);
  EXPECT_NEAR(e.trans_m.max, 0, kPositionRounding);
  EXPECT_EQ(e.judged, 100U);
  EXPECT_NEAR(e.path_m, 10, 0.05) << "40 m of jump are no way";
}

TEST(Evaluate, WithoutStepsHolesInTheEstimateAreScansWithoutAClaim) {
  const auto kept = [](double t) { return t < 10 || t >= 14.95; };
  const Evaluation e = judged(only(claims_of(20, straight), kept), truth_of(20, straight));
  EXPECT_EQ(e.scans, 200U);
  EXPECT_EQ(e.claimed, 150U);
  // Of the 200 scans those from 2.1 s on count: 180, of which 50 are missing.
  EXPECT_EQ(e.coverage.of, 180U);
  EXPECT_EQ(e.coverage.count, 130U);
  EXPECT_EQ(e.success.count, 130U);
}

TEST(Evaluate, WithoutStepsAnEstimateThatStopsEarlyIsMissingTheRest) {
  const Evaluation e = judged(claims_of(11, straight), truth_of(21, straight));
  EXPECT_EQ(e.scans, 210U);
  EXPECT_EQ(e.coverage.count, 90U);
  EXPECT_EQ(e.coverage.of, 190U);
  EXPECT_FALSE(e.e2e_m) << "nothing was claimed at the last scan";
}

TEST(Evaluate, WithoutStepsAnEstimateThatBeginsLateIsMissingTheScansBefore) {
  const auto kept = [](double t) { return t > 5.05; };
  const Evaluation e = judged(only(claims_of(20, straight), kept), truth_of(20, straight));
  EXPECT_EQ(e.scans, 200U);
  EXPECT_EQ(e.coverage.of, 180U);
  EXPECT_EQ(e.coverage.count, 150U);
}

TEST(Evaluate, WithStepsTheirRowsAreTheScansThatWereDue) {
  RunContext context;
  context.steps = steps(0.1, 20, [](double t) { return t < 10 ? "TRACKING" : "LOST"; });
  const Trajectory estimate = only(claims_of(20, straight), [](double t) { return t < 10; });
  const Evaluation e = judged(estimate, truth_of(20, straight), context);
  EXPECT_TRUE(e.from_steps);
  EXPECT_EQ(e.scans, 200U);
  EXPECT_EQ(e.coverage.of, 180U);
  EXPECT_EQ(e.coverage.count, 79U);
  EXPECT_FALSE(e.e2e_m);
}

TEST(Evaluate, SuccessNeedsBothLimitsAndAClaim) {
  const auto where = [](double t) {
    if (t < 5) return straight(t) * pose(0, 0.29, 0, 4.9 * kDegree);
    if (t < 10) return straight(t) * pose(0, 0.31);
    return straight(t) * pose(0, 0, 0, 5.1 * kDegree);
  };
  const Evaluation e = judged(claims_of(20, where), truth_of(20, straight));
  EXPECT_EQ(e.success.of, 180U);
  EXPECT_EQ(e.success.count, 29U) << "2.1 s to 4.9 s";
}

TEST(Evaluate, MisleadingAreTrustedClaimsThatAreFarOff) {
  const auto where = [](double t) { return straight(t) * pose(0, t < 10 ? 0 : 0.6); };
  RunContext context;
  context.steps = steps(0.1, 20, [](double t) {
    return t < 12 ? "TRACKING" : t < 15 ? "DEGRADED" : t < 18 ? "SUSPECT" : "DEAD_RECKONING";
  });
  const Evaluation e = judged(claims_of(20, where), truth_of(20, straight), context);
  EXPECT_EQ(e.misleading.of, 180U);
  EXPECT_EQ(e.misleading.count, 50U) << "10 s to 14.9 s; SUSPECT and DEAD_RECKONING warn";
  const Evaluation without = judged(claims_of(20, where), truth_of(20, straight));
  EXPECT_EQ(without.misleading.count, 101U) << "without steps every claim counts as TRACKING";
}

TEST(Evaluate, ARotationOfMoreThanFiveDegreesMisleadsToo) {
  const auto where = [](double t) { return straight(t) * pose(0, 0, 0, 6 * kDegree); };
  const Evaluation e = judged(claims_of(20, where), truth_of(20, straight));
  EXPECT_EQ(e.misleading.count, e.misleading.of);
}

TEST(Evaluate, AnErrorAlongADeclaredWeakDirectionDoesNotMislead) {
  const auto where = [](double t) { return straight(t) * pose(2, t < 10 ? 0.1 : 0.6); };
  RunContext context;
  context.steps = steps(0.1, 20, [](double) { return "DEGRADED"; });
  for (StepRow& row : context.steps) row.weak_directions = {Eigen::Vector3d::UnitX()};
  const Evaluation e = judged(claims_of(20, where), truth_of(20, straight), context);
  EXPECT_EQ(e.misleading.count, 101U) << "only where it is 0.6 m off to the side";
  EXPECT_EQ(e.success.count, 0U) << "declared or not, the pose is 2 m wrong";
  for (StepRow& row : context.steps) row.status = "TRACKING";
  const Evaluation tracking = judged(claims_of(20, where), truth_of(20, straight), context);
  EXPECT_EQ(tracking.misleading.count, 180U) << "TRACKING declares nothing";
}

TEST(Evaluate, SharesLeaveOutTheFirstTwoSecondsButErrorsDoNot) {
  const auto where = [](double t) { return straight(t) * pose(0, t < 2.05 ? 3 : 0); };
  const Evaluation e = judged(claims_of(20, where), truth_of(20, straight));
  EXPECT_NEAR(e.trans_m.max, 3, kPositionRounding);
  EXPECT_EQ(e.misleading.count, 0U);
  EXPECT_DOUBLE_EQ(e.success.value(), 1);
}

TEST(Evaluate, RepeatedStampsCountOnce) {
  Trajectory estimate = claims_of(10, straight);
  estimate.insert(estimate.begin() + 50, {estimate[49].t, pose(1000)});
  const Evaluation e = judged(estimate, truth_of(10, straight));
  EXPECT_EQ(e.claimed, 100U);
  EXPECT_NEAR(e.trans_m.max, 0, kPositionRounding);
  ASSERT_EQ(e.warnings.size(), 1U);
  EXPECT_THAT(e.warnings[0],
              HasSubstr("claims that repeat the stamp of the one before, left out: 1"));
}

TEST(Evaluate, StepsOfAnotherRunAreNotUsedAndSaidSo) {
  RunContext context;
  context.steps = steps(1000, 1020, [](double) { return "TRACKING"; });
  const Evaluation e = judged(claims_of(20, straight), truth_of(20, straight), context);
  EXPECT_FALSE(e.from_steps);
  EXPECT_EQ(e.scans, 200U);
  ASSERT_EQ(e.warnings.size(), 1U);
  EXPECT_THAT(e.warnings[0], HasSubstr("steps.csv"));
}

TEST(Evaluate, AnOdometryIsAlignedAndNotJudgedByTheStatusesOfTheMap) {
  const SE3 T_map_odom = pose(30, -5, 1, 1.1);
  const Trajectory estimate = claims_of(30, circle, T_map_odom.inverse());
  RunContext context;
  context.is_odometry = true;
  context.steps = steps(0.1, 30, [](double) { return "LOST"; });
  EvaluationOptions options;
  options.align = Alignment::kRigid;
  const Evaluation e = judged(estimate, truth_of(30, circle), context, options);
  EXPECT_NEAR(e.trans_m.max, 0, 1e-8);
  EXPECT_DOUBLE_EQ(e.trusted.value(), 1);
  EXPECT_NEAR((e.T_truth_estimate.translation - T_map_odom.translation).norm(), 0, 1e-8);
}

TEST(Evaluate, ARunThatClaimedNothingIsAResultAndNoError) {
  RunContext context;
  context.steps = steps(0.1, 20, [](double) { return "INITIALIZING"; });
  const Evaluation e = judged({}, truth_of(20, straight), context);
  EXPECT_DOUBLE_EQ(e.coverage.value(), 0);
  EXPECT_DOUBLE_EQ(e.success.value(), 0);
  EXPECT_TRUE(std::isnan(e.trans_m.rmse));
}

TEST(Evaluate, SameInputSameBits) {
  const auto where = [](double t) { return circle(t) * pose(0.01 * std::sin(7 * t), 0, 0, 0.01); };
  const Evaluation a = judged(claims_of(30, where), truth_of(30, circle));
  const Evaluation b = judged(claims_of(30, where), truth_of(30, circle));
  EXPECT_EQ(a.trans_m.rmse, b.trans_m.rmse);
  EXPECT_EQ(a.drift[1].trans_rmse_m, b.drift[1].trans_rmse_m);
}

}  // namespace
}  // namespace holdfast::evaluation::testing
