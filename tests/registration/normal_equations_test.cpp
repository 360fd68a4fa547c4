#include "holdfast/registration/normal_equations.hpp"

#include <gtest/gtest.h>

#include "holdfast/core/random.hpp"

namespace holdfast::registration {
namespace {

constexpr double kRobustScale = 3.0;

/// Random pairs whose residuals are a few sigmas at `pose`.
Correspondences random_pairs(std::size_t n, const SE3& pose, std::uint64_t seed) {
  RandomStream random(seed, "pairs");
  Correspondences c;
  c.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d q(random.uniform(-8, 8), random.uniform(-8, 8), random.uniform(-2, 2));
    const Eigen::Vector3d normal =
        Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    const double residual = random.normal(0, 0.04);
    c.px[i] = static_cast<float>(q.x());
    c.py[i] = static_cast<float>(q.y());
    c.pz[i] = static_cast<float>(q.z());
    c.nx[i] = static_cast<float>(normal.x());
    c.ny[i] = static_cast<float>(normal.y());
    c.nz[i] = static_cast<float>(normal.z());
    c.offset[i] = static_cast<float>(normal.dot(pose * q) - residual);
    c.information[i] = i % 7 == 3 ? 0.0F : 2500.0F;
    c.age_s[i] = static_cast<float>(random.uniform(-0.1, 0.0));
  }
  return c;
}

SE3 some_pose(const Eigen::Vector3d& rotation) { return {so3::exp(rotation), {3.0, -2.0, 0.5}}; }

NormalEquations at(const Correspondences& pairs, const SE3& pose, int threads = 1) {
  WorkerPool pool(threads);
  std::vector<NormalEquations> partials;
  return linearise(pairs, pose, kRobustScale, pool, partials);
}

SE3 moved(const SE3& pose, int axis, double step) {
  Eigen::Matrix<double, 6, 1> d = Eigen::Matrix<double, 6, 1>::Zero();
  d[axis] = step;
  return {pose.rotation * so3::exp(d.tail<3>()), pose.translation + d.head<3>()};
}

class AtRotation : public ::testing::TestWithParam<std::array<double, 3>> {};

TEST_P(AtRotation, GradientIsHalfTheDerivativeOfTheRobustCost) {
  const auto [x, y, z] = GetParam();
  const SE3 pose = some_pose({x, y, z});
  const Correspondences pairs = random_pairs(3000, pose, 1);
  const NormalEquations e = at(pairs, pose);
  // Float residuals at 10 m are good to 1e-6 m; a step of 1e-3 leaves a relative error below 1 %.
  constexpr double kStep = 1e-3;
  const double scale = e.g.head<6>().norm();
  for (int axis = 0; axis < 6; ++axis) {
    const double numeric =
        (at(pairs, moved(pose, axis, kStep)).cost - at(pairs, moved(pose, axis, -kStep)).cost) /
        (2 * kStep);
    EXPECT_NEAR(2 * e.g[axis], numeric, 0.02 * scale) << "axis " << axis;
  }
}

TEST_P(AtRotation, OneStepReachesTheExactPoseOfNoiseFreePairs) {
  const auto [x, y, z] = GetParam();
  const SE3 truth = some_pose({x, y, z});
  Correspondences pairs = random_pairs(3000, truth, 2);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Vector3d q(pairs.px[i], pairs.py[i], pairs.pz[i]);
    const Eigen::Vector3d n(pairs.nx[i], pairs.ny[i], pairs.nz[i]);
    pairs.offset[i] = static_cast<float>(n.dot(truth * q));
  }
  SE3 pose = moved(moved(truth, 0, 0.01), 4, 0.003);
  for (int k = 0; k < 8; ++k) {
    const NormalEquations e = at(pairs, pose);
    const Eigen::Matrix<double, 6, 1> d = -e.H.topLeftCorner<6, 6>().ldlt().solve(e.g.head<6>());
    pose.translation += d.head<3>();
    pose.rotation = (pose.rotation * so3::exp(d.tail<3>())).normalized();
  }
  // Float: positions of 10 m are known to 1e-6 m.
  EXPECT_LT((pose.translation - truth.translation).norm(), 5e-6);
  EXPECT_LT(so3::angle_between(pose.rotation, truth.rotation), 2e-6);
}

INSTANTIATE_TEST_SUITE_P(IdentityRandomAndNearPi, AtRotation,
                         ::testing::Values(std::array{0.0, 0.0, 0.0}, std::array{1e-5, 0.0, 0.0},
                                           std::array{0.4, -0.9, 1.3},
                                           std::array{0.0, 0.0, 3.1415}));

TEST(NormalEquations, VelocityColumnsAreThePositionColumnsTimesTheAge) {
  const SE3 pose = some_pose({0.1, 0.2, 0.3});
  Correspondences pairs = random_pairs(64, pose, 3);
  for (float& age : pairs.age_s) age = -0.05F;
  const NormalEquations e = at(pairs, pose);
  const Eigen::Matrix3d pp = e.H.block<3, 3>(kPosition, kPosition);
  EXPECT_TRUE((e.H.block<3, 3>(kPosition, kVelocity)).isApprox(-0.05 * pp, 1e-5));
  EXPECT_TRUE((e.H.block<3, 3>(kVelocity, kVelocity)).isApprox(0.0025 * pp, 1e-5));
  const Eigen::Matrix3d pr = e.H.block<3, 3>(kPosition, kRotation);
  EXPECT_TRUE((e.H.block<3, 3>(kVelocity, kRotation)).isApprox(-0.05 * pr, 1e-5));
}

TEST(NormalEquations, PointsWithoutAPlaneDoNotCount) {
  const SE3 pose = some_pose({0, 0, 0});
  Correspondences pairs = random_pairs(70, pose, 4);
  EXPECT_EQ(at(pairs, pose).pairs, 60);
  for (float& information : pairs.information) information = 0;
  EXPECT_EQ(at(pairs, pose).weight, 0);
}

TEST(NormalEquations, HaveTheSameBitsWithOneTwoAndEightThreads) {
  const SE3 pose = some_pose({0.3, 0.2, 0.1});
  const Correspondences pairs = random_pairs(10'007, pose, 5);
  const NormalEquations one = at(pairs, pose, 1);
  for (const int threads : {2, 8}) {
    const NormalEquations many = at(pairs, pose, threads);
    EXPECT_EQ(one.H, many.H);
    EXPECT_EQ(one.g, many.g);
    EXPECT_EQ(one.cost, many.cost);
  }
}

}  // namespace
}  // namespace holdfast::registration
