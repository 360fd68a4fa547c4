#include <gtest/gtest.h>

#include "tests/integration/drive_in_map.hpp"

/// Same log, same bits.
namespace holdfast::testing {
namespace {

void expect_same_bits(const std::vector<StepReport>& a, const std::vector<StepReport>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].stamp, b[i].stamp);
    ASSERT_EQ(a[i].pose_time, b[i].pose_time);
    ASSERT_EQ(a[i].state, b[i].state);
    ASSERT_EQ(a[i].reason, b[i].reason);
    ASSERT_EQ(a[i].T_map_body.translation, b[i].T_map_body.translation) << "scan " << i;
    ASSERT_EQ(a[i].T_map_body.rotation.coeffs(), b[i].T_map_body.rotation.coeffs());
    ASSERT_EQ(a[i].matches, b[i].matches);
    ASSERT_EQ(a[i].inlier_share, b[i].inlier_share);
    ASSERT_EQ(a[i].mean_abs_residual_m, b[i].mean_abs_residual_m);
    ASSERT_EQ(a[i].sigma_trans_m, b[i].sigma_trans_m);
    ASSERT_EQ(a[i].sigma_rot_rad, b[i].sigma_rot_rad);
    ASSERT_EQ(a[i].weak_directions.size(), b[i].weak_directions.size());
  }
}

TEST(Determinism, ADriveHasTheSameBitsInTwoRunsAndWithOneAndTwoThreads) {
  simulation::SimulationOptions options;
  options.scenario = "corridor";
  options.duration_s = 10.0;
  SurveyedDrive drive(options);
  const auto events = record(*drive.simulation);
  const auto run = [&](int threads) {
    Recording log(events);
    return drive.localize(log, threads);
  };
  const auto first = run(1);
  ASSERT_EQ(first.size(), drive.simulation->scan_count());
  EXPECT_GT(std::count_if(first.begin(), first.end(),
                          [](const StepReport& r) { return claims_pose(r.state); }),
            90);
  expect_same_bits(first, run(1));
  expect_same_bits(first, run(2));
}

}  // namespace
}  // namespace holdfast::testing
