#include "evaluation/alignment.hpp"

#include "tests/evaluation/scenes.hpp"

namespace holdfast::evaluation::testing {
namespace {

const SE3 kOffset = {so3::exp({0.3, -0.2, 2.1}), {4, -7, 1}};

/// Truth poses and the same seen from another frame.
void expect_offset_found(const std::vector<SE3>& truth) {
  std::vector<SE3> estimate;
  for (const SE3& pose : truth) estimate.push_back(kOffset.inverse() * pose);
  const SE3 found = align_rigid(estimate, truth);
  EXPECT_NEAR((found.translation - kOffset.translation).norm(), 0, 1e-8);
  EXPECT_NEAR(so3::angle_between(found.rotation, kOffset.rotation), 0, 1e-8);
}

std::vector<SE3> poses_along(const std::function<SE3(double)>& where) {
  std::vector<SE3> poses;
  for (int i = 0; i < 50; ++i) poses.push_back(where(i));
  return poses;
}

TEST(Alignment, FindsTheFrameOfACurvedDrive) { expect_offset_found(poses_along(circle)); }

TEST(Alignment, OfAStraightDriveTakesTheRollFromTheOrientations) {
  expect_offset_found(poses_along(straight));
}

TEST(Alignment, OfATurnOnTheSpotTakesTheRotationFromTheOrientations) {
  expect_offset_found(poses_along([](double t) { return pose(1, 2, 3, 0.1 * t); }));
}

TEST(Alignment, OfOnePoseIsExact) { expect_offset_found({pose(1, 2, 3, 0.4)}); }

TEST(Alignment, OrientationsDoNotMoveWhatPositionsDetermine) {
  // Every orientation of the estimate is off by 10 degrees; positions agree.
  const std::vector<SE3> truth = poses_along(circle);
  std::vector<SE3> estimate = truth;
  for (SE3& pose : estimate) pose.rotation = pose.rotation * so3::exp({0, 0, 10 * kDegree});
  // The pull is that of a 1 cm lever against a 10 m one: 10 deg * (0.01 / 10)^2, twice over.
  const double angle = so3::angle_between(align_rigid(estimate, truth).rotation, {1, 0, 0, 0});
  EXPECT_LT(angle, 10 * kDegree * 4e-6);
}

}  // namespace
}  // namespace holdfast::evaluation::testing
