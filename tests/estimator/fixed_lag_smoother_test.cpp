#include "holdfast/estimator/fixed_lag_smoother.hpp"

#include <Eigen/Cholesky>
#include <cstring>

#include "tests/estimator/simulated_chain.hpp"

namespace holdfast::estimator {
namespace {

using testing::Chain;
using testing::ChainOptions;
using testing::simulate;

double squared(const Eigen::VectorXd& error, const Eigen::MatrixXd& P) {
  return error.dot(P.llt().solve(error));
}

/// Mean of chi-square values of `dimensions` over `n` runs: 4 sigma bounds, left by chance once in
/// 16 000 tests.
void expect_chi_square(double mean, int dimensions, int n) {
  EXPECT_NEAR(mean, dimensions, 4 * std::sqrt(2.0 * dimensions / n));
}

class Consistency : public ::testing::TestWithParam<bool> {};

TEST_P(Consistency, TheErrorIsWhatTheCovarianceSays) {
  constexpr int kSeeds = 100;
  double all = 0, pose = 0, velocity = 0, biases = 0, innovation = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Chain chain = simulate(seed);
    FixedLagSmoother smoother(chain.config());
    OptimiseReport last;
    run(chain, smoother, GetParam(), 30, [&](int, const OptimiseReport& r) { last = r; });
    ASSERT_TRUE(last.solved && last.converged && last.map_used);
    const Vector18d error = smoother.newest().minus(chain.truth.back());
    const Matrix18d P = smoother.covariance_of_newest();
    all += squared(error, P) / kSeeds;
    pose += squared(error.head<6>(), P.topLeftCorner<6, 6>()) / kSeeds;
    velocity += squared(error.segment<3>(6), P.block<3, 3>(6, 6)) / kSeeds;
    biases += squared(error.segment<6>(9), P.block<6, 6>(9, 9)) / kSeeds;
    innovation += smoother.innovation(last) / kSeeds;
  }
  expect_chi_square(all, 18, kSeeds);
  expect_chi_square(pose, 6, kSeeds);
  expect_chi_square(velocity, 3, kSeeds);
  expect_chi_square(biases, 6, kSeeds);
  expect_chi_square(innovation, 6, kSeeds);
}

INSTANTIATE_TEST_SUITE_P(WithoutAndWithOdometry, Consistency, ::testing::Bool());

TEST(FixedLagSmoother, HasTheSameBitsInTwoRuns) {
  const Chain chain = simulate(1);
  std::array<Vector18d, 2> ends;
  std::array<Matrix18d, 2> covariances;
  for (int i = 0; i < 2; ++i) {
    FixedLagSmoother smoother(chain.config());
    if (i == 1) run(simulate(2), smoother, false, 7);  // what was before a reset leaves no trace
    run(chain, smoother, true, 30);
    ends[i] = smoother.newest().minus(chain.truth.back());
    covariances[i] = smoother.covariance_of_newest();
  }
  EXPECT_EQ(std::memcmp(ends[0].data(), ends[1].data(), sizeof(Vector18d)), 0);
  EXPECT_EQ(std::memcmp(covariances[0].data(), covariances[1].data(), sizeof(Matrix18d)), 0);
}

TEST(FixedLagSmoother, StaysWellPosedOverAMinuteOfPreciseScans) {
  ChainOptions options;
  options.nodes = 600;
  options.imu = {1e-4, 1e-3, 1e-7, 1e-6};  // a perfect IMU: the most unequal information
  options.position_sigma_m = 1e-4;
  options.rotation_sigma_rad = 2e-5;
  const Chain chain = simulate(8, options);
  FixedLagSmoother smoother(chain.config());
  run(chain, smoother, true, options.nodes, [&](int k, const OptimiseReport& report) {
    ASSERT_TRUE(report.solved && report.converged) << k;
    const Matrix18d P = smoother.covariance_of_newest();
    ASSERT_EQ(P.llt().info(), Eigen::Success) << k;
    const Vector18d error = smoother.newest().minus(chain.truth[k]);
    ASSERT_LT(squared(error, P), 74) << k;  // 1 in 10^8 for each of 600
  });
}

TEST(FixedLagSmoother, WhatIsNotPositiveDefiniteIsReported) {
  const Chain chain = simulate(9);
  FixedLagSmoother smoother(chain.config());
  run(chain, smoother, false, 5);
  smoother.push(chain.imu[5]);
  registration::NormalEquations broken;
  broken.H = -1e12 * registration::Matrix9d::Identity();
  const auto report = smoother.optimise(
      [&](const NodeState& x) { return std::optional<MapFactor>(MapFactor(broken, x)); });
  EXPECT_FALSE(report.solved);
  EXPECT_TRUE(smoother.newest().T_map_body.translation.allFinite());
  EXPECT_FALSE(report.map_used);
}

TEST(FixedLagSmoother, HoldsAsManyNodesAsItsWindow) {
  const Chain chain = simulate(3);
  FixedLagSmoother smoother(chain.config(5));
  run(chain, smoother, false, 30, [&](int k, const OptimiseReport&) {
    EXPECT_EQ(smoother.size(), std::min(k + 1, 5));
    EXPECT_EQ(smoother.newest().t, chain.truth[k].t);
    EXPECT_EQ(smoother.node(0).t, chain.truth[std::max(0, k - 4)].t);
  });
}

TEST(FixedLagSmoother, WithoutAMapThePredictionStaysAndItsUncertaintyGrows) {
  const Chain chain = simulate(4);
  FixedLagSmoother smoother(chain.config());
  run(chain, smoother, false, 15);
  double sigma = 0;
  for (int k = 15; k < 30; ++k) {
    smoother.push(chain.imu[k]);
    const NodeState predicted = smoother.newest();
    const auto report =
        smoother.optimise([](const NodeState&) { return std::optional<MapFactor>(); });
    EXPECT_TRUE(report.solved && report.converged);
    EXPECT_FALSE(report.map_used);
    // Steps of elimination errors: information of 1e12 against states of about 10.
    EXPECT_LT(smoother.newest().minus(predicted).head<6>().norm(), 1e-6);
    const Matrix18d P = smoother.covariance_of_newest();
    EXPECT_GT(P(0, 0), sigma);
    sigma = P(0, 0);
    const Vector18d error = smoother.newest().minus(chain.truth[k]);
    EXPECT_LT(squared(error.head<9>(), P.topLeftCorner<9, 9>()), 38);  // 1 in 50 000
  }
}

TEST(FixedLagSmoother, AGuessOffTheMarkIsDrawnBack) {
  const Chain chain = simulate(5);
  FixedLagSmoother straight(chain.config());
  FixedLagSmoother astray(chain.config());
  run(chain, straight, false, 20);
  run(chain, astray, false, 19);
  astray.push(chain.imu[19]);
  NodeState guess = astray.newest();
  Vector18d off = Vector18d::Zero();
  off.head<6>() << 0.3, -0.2, 0.1, 0.05, -0.05, 0.1;
  guess.add(off);
  astray.set_guess(guess);
  const auto report =
      astray.optimise([&](const NodeState& x) { return std::optional(chain.observed[19].at(x)); });
  EXPECT_GT(report.linearisations, 1);
  const Matrix18d P = straight.covariance_of_newest();
  // A hundredth of a sigma: the limit of convergence is 1e-5 rad against 5e-4.
  EXPECT_LT(squared(astray.newest().minus(straight.newest()), P), 0.02 * 0.02);
}

TEST(FixedLagSmoother, ABiasThatJumpedIsFoundAndLearned) {
  ChainOptions options;
  options.jump_in_interval = 20;
  double largest_by_chance = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Chain quiet = simulate(seed);
    FixedLagSmoother still(quiet.config());
    run(quiet, still, false, 24);
    largest_by_chance = std::max(largest_by_chance, still.bias_jump_gain(3));

    const Chain chain = simulate(seed, options);
    FixedLagSmoother smoother(chain.config());
    run(chain, smoother, false, 24);  // three intervals after that of the jump
    const double gain = smoother.bias_jump_gain(3);
    EXPECT_GT(gain, 40) << seed;  // by chance once in 10^4
    const Vector18d before = smoother.newest().minus(chain.truth[23]);
    smoother.allow_bias_jump(3);
    EXPECT_LT(smoother.bias_jump_gain(3), 1);
    smoother.optimise([&](const NodeState& x) { return std::optional(chain.observed[23].at(x)); });
    const Vector18d after = smoother.newest().minus(chain.truth[23]);
    const Matrix18d P = smoother.covariance_of_newest();
    EXPECT_LT(squared(after.head<15>(), P.topLeftCorner<15, 15>()), 60) << seed;
    EXPECT_LT(after.segment<3>(12).norm(), before.segment<3>(12).norm()) << seed;
  }
  EXPECT_LT(largest_by_chance, 40);
}

TEST(FixedLagSmoother, AHeldReadingIsAMotionThatTheMapCanTell) {
  const Chain chain = simulate(6);
  FixedLagSmoother smoother(chain.config());
  run(chain, smoother, false, 20);
  for (int k = 20; k < 30; ++k) {
    smoother.push(steady_readings(smoother.newest(), chain.truth[k].t));
    smoother.optimise([&](const NodeState& x) { return std::optional(chain.observed[k].at(x)); });
    const Matrix18d P = smoother.covariance_of_newest();
    const Vector18d error = smoother.newest().minus(chain.truth[k]);
    EXPECT_LT(squared(error.head<6>(), P.topLeftCorner<6, 6>()), 34);  // 1 in 100 000
    EXPECT_LT(error.head<3>().norm(), 5 * chain.options.position_sigma_m);
    EXPECT_LT(error.segment<3>(6).norm(), 5 * std::sqrt(P.block<3, 3>(6, 6).trace()));
  }
}

TEST(FixedLagSmoother, RunsWithTheWeightsOfThePrint) {
  const Chain chain = simulate(7);
  SmootherConfig config = chain.config();
  config.imu_weight = 1.2;
  FixedLagSmoother smoother(config);
  smoother.reset(chain.start, chain.start_covariance);
  for (int k = 1; k < 30; ++k) {
    const auto between =
        BetweenFactor::printed(chain.truth[k - 1].T_map_body, chain.truth[k].T_map_body, {});
    smoother.push(chain.imu[k], between);
    const auto report = smoother.optimise(
        [&](const NodeState& x) { return std::optional(chain.observed[k].at(x).scaled(0.8)); });
    EXPECT_TRUE(report.solved && report.converged);
  }
  EXPECT_LT(smoother.newest().minus(chain.truth.back()).head<3>().norm(),
            5 * chain.options.position_sigma_m);
}

}  // namespace
}  // namespace holdfast::estimator
