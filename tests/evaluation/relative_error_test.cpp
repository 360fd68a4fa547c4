#include "evaluation/relative_error.hpp"

#include "tests/evaluation/scenes.hpp"

namespace holdfast::evaluation::testing {
namespace {

Evaluation judged(const std::function<SE3(double)>& claim, const Trajectory& truth, double end,
                  const RunContext& context = {}) {
  Result<Evaluation> result = evaluate(sample(0.1, end, 10, claim), truth, {}, context);
  EXPECT_TRUE(result.ok());
  return result.ok() ? std::move(*result) : Evaluation{};
}

TEST(RelativeError, OfADriftByOnePercentIsOnePercentOfTheWay) {
  const auto claim = [](double t) { return pose(1.01 * t); };
  const Evaluation e = judged(claim, truth_of(100, straight), 100);
  for (const RelativeError& drift : e.drift) {
    EXPECT_NEAR(drift.drift_percent, 1, 0.005) << drift.length_m;  // way in steps of 2 cm
    // The end is the first scan beyond the length, up to 0.1 m of way plus 2 cm later.
    EXPECT_GE(drift.trans_rmse_m, 0.01 * drift.length_m - 3e-4);
    EXPECT_LE(drift.trans_rmse_m, 0.01 * (drift.length_m + 0.13));
    EXPECT_NEAR(drift.rot_rmse_deg, 0, 1e-5);
  }
  EXPECT_NEAR(static_cast<double>(e.drift[0].segments), 900, 3);
  EXPECT_NEAR(static_cast<double>(e.drift[2].segments), 500, 3);
}

TEST(RelativeError, ATurnPerMetreGivesAnAngleInProportion) {
  const auto claim = [](double t) { return straight(t) * pose(0, 0, 0, 0.1 * kDegree * t); };
  const Evaluation e = judged(claim, truth_of(60, straight), 60);
  EXPECT_NEAR(e.drift[0].rot_rmse_deg, 1, 0.013);
  EXPECT_NEAR(e.drift[1].rot_rmse_deg, 2, 0.013);
}

TEST(RelativeError, AConstantOffsetOfTheFrameIsNoDrift) {
  const SE3 offset = pose(3, 4, 5, 0.7);
  const auto claim = [&](double t) { return offset * circle(t); };
  const Evaluation e = judged(claim, truth_of(80, circle), 80);
  EXPECT_NEAR(e.drift[1].trans_rmse_m, 0, 1e-9);
  EXPECT_GT(e.drift[1].segments, 500U);
}

TEST(RelativeError, OfADriveThatIsTooShortIsNotKnown) {
  const Evaluation e = judged(straight, truth_of(15, straight), 15);
  EXPECT_GT(e.drift[0].segments, 0U);
  EXPECT_EQ(e.drift[1].segments, 0U);
  EXPECT_TRUE(std::isnan(e.drift[1].trans_rmse_m));
}

TEST(RelativeError, SegmentsAcrossATeleportAreLeftOut) {
  Trajectory truth = sample(0, 20, 200, straight);
  const auto moved = [](double t) { return pose(t, 100); };
  const Trajectory after = sample(20, 40, 200, moved);
  truth.insert(truth.end(), after.begin(), after.end());
  // The claim follows the jump 1 s late: wrong across it, right within either part.
  const auto claim = [&](double t) { return t < 20.995 ? straight(t) : moved(t); };
  const auto late = [](double t) { return t > 19.995 && t < 20.995; };
  const Trajectory estimate = only(sample(0.1, 40, 10, claim), [&](double t) { return !late(t); });
  Result<Evaluation> e = evaluate(estimate, truth);
  ASSERT_TRUE(e.ok());
  EXPECT_NEAR(e->drift[0].trans_rmse_m, 0, 1e-9);
  EXPECT_NEAR(static_cast<double>(e->drift[0].segments), 99 + 91, 3);
}

TEST(RelativeError, OfAnOdometryLeavesOutItsBreaks) {
  const auto claim = [](double t) { return t < 30 ? straight(t) : pose(0, t); };
  RunContext context;
  context.is_odometry = true;
  context.steps = steps(0.1, 60, [](double) { return "TRACKING"; });
  for (StepRow& row : context.steps) row.odom_epoch = to_seconds(row.pose_time) < 29.995 ? 0 : 1;
  const auto turned = [&](double t) { return t < 29.995 ? claim(t) : pose(t - 30, 0); };
  const Evaluation broken = judged(turned, truth_of(60, straight), 60, context);
  EXPECT_NEAR(broken.drift[0].trans_rmse_m, 0, 1e-9);
  context.is_odometry = false;
  const Evaluation whole = judged(turned, truth_of(60, straight), 60, context);
  EXPECT_GT(whole.drift[0].trans_rmse_m, 1) << "the same jump in the map is an error";
}

}  // namespace
}  // namespace holdfast::evaluation::testing
