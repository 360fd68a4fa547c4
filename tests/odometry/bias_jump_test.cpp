#include "holdfast/odometry/bias_jump.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "holdfast/core/random.hpp"
#include "holdfast/odometry/increment.hpp"

namespace holdfast::odometry {
namespace {

using Eigen::Vector3d;
using filter::FilterState;
using Vector6d = BiasJump::Vector6d;

const Vector3d kGravity(0, 0, -9.81);
constexpr TimeNs kScan = kSecond / 10;
constexpr double kPoseSigma = 0.001;  // m; a tenth of it in rad
constexpr int kSettled = 20;          // scans

Vector6d some_jump() {
  Vector6d jump;
  jump << 0.2, -0.2, 0.1, 0.01, -0.02, 0.02;
  return jump;
}

/// A filter of a body that rests in truth at the origin, with a pose from each scan and readings
/// that are wrong by `bias`.
struct Rig {
  explicit Rig(std::uint64_t seed) : random(seed, "pose") {
    state.P.setZero();
    state.P.diagonal() << Vector3d::Constant(1e-6), Vector3d::Constant(1e-8),
        Vector3d::Constant(1e-4), Vector3d::Constant(1e-4), Vector3d::Constant(1e-6);
  }

  /// `shift`: of what the scan sees against the world.
  std::optional<BiasJump> step(const Vector3d& shift = Vector3d::Zero(), double share = 1) {
    const FilterState before = state;
    preprocess::ImuSegment imu;
    for (int i = 0; i <= 20; ++i) {
      imu.samples.push_back(
          {state.t + kScan * i / 20, bias.tail<3>(), Vector3d(bias.head<3>() - kGravity)});
    }
    imu.measured_begin = state.t;
    state.P.setZero();
    propagate(state, imu, kGravity, noise);
    const filter::Matrix15d F = error_transition(before, state, kGravity);
    state.P += F * before.P * F.transpose();
    watch.carry(before, state, kGravity, 0);
    const FilterState predicted = state;
    const filter::Matrix15d left = correct(shift);
    watch.hear(predicted, state, share);
    watch.correct(left, Eigen::Matrix<double, 3, 15>::Zero());
    return watch.believed();
  }

  filter::Matrix15d correct(const Vector3d& shift) {
    Vector6d sigma, noise_now;
    sigma << Vector3d::Constant(kPoseSigma), Vector3d::Constant(0.1 * kPoseSigma);
    for (int i = 0; i < 6; ++i) noise_now[i] = random.normal(0, sigma[i]);
    FilterState seen = state;
    seen.T_map_body = {so3::exp(noise_now.tail<3>()), noise_now.head<3>() + shift};
    Matrix6d S = state.P.topLeftCorner<6, 6>();
    S.diagonal() += sigma.cwiseAbs2();
    const Eigen::Matrix<double, 15, 6> gain = S.ldlt().solve(state.P.topRows<6>()).transpose();
    const Vector6d innovation = seen.minus(state).head<6>();
    state.add(gain * innovation);
    filter::Matrix15d left = filter::Matrix15d::Identity();
    left.leftCols<6>() -= gain;
    state.P = (left * state.P).eval();
    state.P = (0.5 * (state.P + state.P.transpose())).eval();
    return left;
  }

  RandomStream random;
  filter::ImuNoiseConfig noise = {1e-4, 3e-3, 1e-5, 1e-4};
  Vector6d bias = Vector6d::Zero();
  FilterState state;
  BiasJumpWatch watch;
};

TEST(BiasJumpWatch, NothingIsFoundWhereNothingJumped) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Rig rig(seed);
    for (int k = 0; k < 100; ++k) EXPECT_FALSE(rig.step()) << "scan " << k << ", seed " << seed;
  }
}

TEST(BiasJumpWatch, AJumpIsFoundWithinThreeScansAndItsSizeIsAsGoodAsItSays) {
  constexpr int kSeeds = 20;
  double squares = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Rig rig(seed);
    for (int k = 0; k < kSettled; ++k) EXPECT_FALSE(rig.step());
    rig.bias = some_jump();
    std::optional<BiasJump> jump;
    int scans = 0;
    while (!jump && scans < 10) jump = rig.step(), ++scans;
    ASSERT_TRUE(jump) << "seed " << seed;
    EXPECT_EQ(scans, 3);
    EXPECT_EQ(jump->age, 3);
    const Vector6d off = jump->size - some_jump();
    squares += off.dot(jump->P.ldlt().solve(off));
    // The state's own errors are less than what the jump made of them.
    FilterState right = rig.state;
    right.add(jump->now * jump->size);
    EXPECT_LT((right.gyro_bias - some_jump().tail<3>()).norm(), 0.1 * some_jump().tail<3>().norm());
    EXPECT_LT(right.v_map.norm(), 0.5 * rig.state.v_map.norm());
  }
  // The mean over 20 seeds of chi-square of 6; its sigma is 0.13 of it. Biases walk and rested
  // badly known before, so that it is less.
  EXPECT_LT(squares / (6 * kSeeds), 1.5);
}

TEST(BiasJumpWatch, ACrowdThatWalksAsOneIsNoJump) {
  for (const double speed : {0.2, 0.7, 1.4}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      Rig rig(seed);
      for (int k = 0; k < kSettled; ++k) rig.step();
      for (int k = 1; k < 30; ++k) {
        // Most of what is seen walks on along x; so many fewer points agree.
        EXPECT_FALSE(rig.step({0.1 * speed * k, 0, 0}, 0.6)) << "scan " << k << ", " << speed;
      }
    }
  }
}

TEST(BiasJumpWatch, ABodyThatWasSetDownElsewhereHasNoJump) {
  Rig rig(1);
  for (int k = 0; k < kSettled; ++k) rig.step();
  for (int k = 0; k < 20; ++k) EXPECT_FALSE(rig.step({2, 1, 0})) << "scan " << k;
}

TEST(BiasJumpWatch, AJumpBeyondAllSizesIsNotBelieved) {
  Rig rig(1);
  for (int k = 0; k < kSettled; ++k) rig.step();
  rig.bias = 10 * some_jump();
  for (int k = 0; k < 20; ++k) EXPECT_FALSE(rig.step()) << "scan " << k;
}

}  // namespace
}  // namespace holdfast::odometry
