#include "holdfast/estimator/preintegration.hpp"

#include <Eigen/Cholesky>

#include "tests/estimator/scene.hpp"

namespace holdfast::estimator {
namespace {

using Eigen::Vector3d;
using testing::kGravity;
using testing::kStart;
using testing::random_vector;

class AtRotation : public testing::AtRotation {};

Preintegration integrated(const preprocess::ImuSegment& imu, const NodeState& at,
                          const Preintegration::Noise& noise = {}) {
  Preintegration p;
  p.integrate(imu, at.accel_bias, at.gyro_bias, noise);
  return p;
}

NodeState level_at_rest() {
  NodeState s;
  s.t = kStart;
  s.gravity_map = kGravity;
  return s;
}

TEST_P(AtRotation, PredictsWhatTheFilterPropagates) {
  const NodeState x = testing::state_at(rotation());
  const auto imu = testing::wild(3);
  filter::FilterState f;
  f.t = x.t;
  f.T_map_body = x.T_map_body;
  f.v_map = x.v_map;
  f.accel_bias = x.accel_bias;
  f.gyro_bias = x.gyro_bias;
  propagate(f, imu, x.gravity_map, {});
  const NodeState y = integrated(imu, x).predict(x);
  // 20 steps, positions of about 10 m.
  const double tolerance = 20 * 10 * tolerances::kRounding;
  EXPECT_EQ(y.t, f.t);
  EXPECT_LT((y.T_map_body.translation - f.T_map_body.translation).norm(), tolerance);
  EXPECT_LT((y.v_map - f.v_map).norm(), tolerance);
  EXPECT_LT(so3::angle_between(y.T_map_body.rotation, f.T_map_body.rotation), tolerance);
}

TEST_P(AtRotation, IncrementsDoNotDependOnTheState) {
  const auto imu = testing::wild(4);
  NodeState x = testing::state_at(rotation());
  x.accel_bias.setZero();
  x.gyro_bias.setZero();
  const Preintegration here = integrated(imu, x);
  const Preintegration there = integrated(imu, level_at_rest());
  EXPECT_EQ(here.increment().position, there.increment().position);
  EXPECT_EQ(here.covariance(), there.covariance());
}

TEST(Preintegration, FreeFallIsAParabola) {
  NodeState x = level_at_rest();
  x.v_map = {1, 2, 3};
  x.T_map_body.rotation = so3::exp({0.3, 0.2, 0.1});
  const NodeState y = integrated(testing::constant(200, {0, 0, 0}, {0, 0, 0}), x).predict(x);
  const double tolerance = 200 * 5 * tolerances::kRounding;
  EXPECT_LT((y.T_map_body.translation - Vector3d(1, 2, 3 - 0.5 * 9.81)).norm(), tolerance);
  EXPECT_LT((y.v_map - Vector3d(1, 2, 3 - 9.81)).norm(), tolerance);
}

TEST(Preintegration, AtRestNothingMoves) {
  NodeState x = level_at_rest();
  x.T_map_body.rotation = so3::exp({0.3, -0.8, 2.1});
  x.accel_bias = {0.1, -0.2, 0.05};
  x.gyro_bias = {0.01, 0.02, -0.03};
  const Vector3d force = x.T_map_body.rotation.conjugate() * -kGravity + x.accel_bias;
  const NodeState y = integrated(testing::constant(200, x.gyro_bias, force), x).predict(x);
  EXPECT_LT(y.minus(x).norm(), 200 * 10 * tolerances::kRounding);
}

TEST(Preintegration, OfNoTimeIsNothing) {
  preprocess::ImuSegment imu;
  imu.samples.push_back({kStart, {1, 2, 3}, {4, 5, 6}});
  const NodeState x = testing::state_at(so3::exp({0.1, 0.2, 0.3}));
  EXPECT_EQ(integrated(imu, x).seconds(), 0);
  EXPECT_LT(integrated(imu, x).predict(x).minus(x).norm(), tolerances::kRounding * 10);
}

Vector9d difference(const MotionIncrement& a, const MotionIncrement& b) {
  Vector9d d;
  d.segment<3>(0) = a.position - b.position;
  d.segment<3>(3) = so3::log(b.rotation.conjugate() * a.rotation);
  d.segment<3>(6) = a.velocity - b.velocity;
  return d;
}

TEST(Preintegration, BiasJacobianIsThatOfIntegratingAgain) {
  const auto imu = testing::wild(5);
  const NodeState x = testing::state_at(so3::exp({0.5, 0, 0}));
  const Preintegration at = integrated(imu, x);
  const auto numeric = testing::differences<9>(x, [&](const NodeState& y) {
    return difference(integrated(imu, y).increment(), at.increment());
  });
  const Eigen::Matrix<double, 9, 6> J = numeric.middleCols<6>(NodeState::kBa);
  // 20 steps of rounding; forces of 10 m/s^2 scale the third derivative.
  const double tolerance = tolerances::difference_error(10, 20 * tolerances::kRounding);
  EXPECT_LT((J - at.bias_jacobian()).cwiseAbs().maxCoeff(), tolerance);
}

TEST(Preintegration, FirstOrderCorrectionIsAsGoodAsItsBoundSays) {
  const auto imu = testing::wild(6);
  const NodeState x = testing::state_at(so3::exp({0.5, 0, 0}));
  const Preintegration at = integrated(imu, x);
  NodeState moved = x;
  moved.gyro_bias += Preintegration::kLargestTurn / at.seconds() * Vector3d(0.48, -0.6, 0.64);
  moved.accel_bias += Vector3d(0.1, 0.2, -0.2);
  const Vector9d error = difference(at.corrected(moved.accel_bias, moved.gyro_bias),
                                    integrated(imu, moved).increment());
  const double turn = Preintegration::kLargestTurn;
  // Second order in the turn, and the accelerometer's change seen in a frame turned by it.
  EXPECT_LT(error.segment<3>(3).norm(), turn * turn);
  EXPECT_LT(error.segment<3>(6).norm(), at.seconds() * (10 * turn * turn + 0.3 * turn));
  EXPECT_LT(error.segment<3>(0).norm(),
            at.seconds() * at.seconds() * (10 * turn * turn + 0.3 * turn));
}

TEST(Preintegration, IsDoneAgainWhenTheGyroscopesBiasMovedFar) {
  const auto imu = testing::wild(7);
  NodeState x = testing::state_at(so3::exp({0.5, 0, 0}));
  Preintegration p = integrated(imu, x);
  x.gyro_bias.x() += 0.9 * Preintegration::kLargestTurn / p.seconds();
  EXPECT_FALSE(p.rebase(x.accel_bias, x.gyro_bias));
  x.gyro_bias.x() += 0.2 * Preintegration::kLargestTurn / p.seconds();
  EXPECT_TRUE(p.rebase(x.accel_bias, x.gyro_bias));
  EXPECT_EQ(p.increment().position, integrated(imu, x).increment().position);
  EXPECT_FALSE(p.rebase(x.accel_bias, x.gyro_bias));
}

/// Adds noise whose mean over each interval is white with the given densities: readings alternate
/// about it, so that neighbouring intervals share no noise, as the covariance assumes.
void add_noise(RandomStream& random, const filter::ImuNoiseConfig& noise,
               preprocess::ImuSegment& imu) {
  Vector3d gyro = Vector3d::Zero();
  Vector3d accel = Vector3d::Zero();
  const double per_root_s = 1 / std::sqrt(to_seconds(testing::kPeriod));
  for (std::size_t i = 1; i < imu.samples.size(); ++i) {
    gyro = 2 * random_vector(random, noise.gyro_noise_density * per_root_s) - gyro;
    accel = 2 * random_vector(random, noise.accel_noise_density * per_root_s) - accel;
    imu.samples[i].gyro_rad_s += gyro;
    imu.samples[i].accel_m_s2 += accel;
  }
}

TEST(Preintegration, CovarianceIsThatOfManyNoisyRuns) {
  constexpr int kRuns = 20000;
  const auto imu = testing::wild(8);
  const NodeState x = testing::state_at(so3::exp({0.5, 0, 0}));
  const Preintegration at = integrated(imu, x);
  const Eigen::LLT<Matrix9d> llt(at.covariance());
  RandomStream random(1, "noise");
  Matrix9d sum = Matrix9d::Zero();
  for (int run = 0; run < kRuns; ++run) {
    auto noisy = imu;
    add_noise(random, filter::ImuNoiseConfig{}, noisy);
    const Vector9d d = difference(integrated(noisy, x).increment(), at.increment());
    const Vector9d whitened = llt.matrixL().solve(d);
    sum += whitened * whitened.transpose();
  }
  // A mean square varies by sqrt(2 / n); white noise within the intervals, which readings do not
  // have, is 1 / (4 N^2) of the position's variance for N = 20 intervals and, where velocity is
  // given, four times that.
  const double tolerance = tolerances::mean_error(std::sqrt(2.0), kRuns) + 1.0 / (20 * 20);
  const Matrix9d deviation = sum / kRuns - Matrix9d::Identity();
  EXPECT_LT(deviation.cwiseAbs().maxCoeff(), tolerance);
}

/// Variance of the integral to `t` of an Ornstein-Uhlenbeck process that starts at zero, by summing
/// its covariance.
double wandered_numerically(const UnmeasuredMotion& u, double sigma, double t) {
  constexpr int kSteps = 1000;
  const double h = t / kSteps;
  const double tau = u.time_constant_s;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int k = 0; k < kSteps; ++k) {
      const double a = (i + 0.5) * h;
      const double b = (k + 0.5) * h;
      sum += std::exp(-std::abs(a - b) / tau) - std::exp(-(a + b) / tau);
    }
  }
  return sigma * sigma * sum * h * h;
}

TEST(Preintegration, AHeldReadingWandersFromTheTruth) {
  const NodeState x = level_at_rest();
  Preintegration::Noise noise{testing::noise_free(), {}};
  for (const double seconds : {0.02, 0.1, 2.0}) {
    const auto held = steady_readings(x, kStart + from_seconds(seconds));
    const Preintegration p = integrated(held, x, noise);
    const double v =
        wandered_numerically(noise.unmeasured, noise.unmeasured.accel_sigma_m_s2, seconds);
    const double r =
        wandered_numerically(noise.unmeasured, noise.unmeasured.gyro_sigma_rad_s, seconds);
    EXPECT_NEAR(p.covariance()(3, 3) / r, 1, 1e-3) << seconds;  // error of the sum: 1 / steps
    // The turned frame adds to it where gravity is seen.
    EXPECT_NEAR(p.covariance()(8, 8) / v, 1, 1e-3) << seconds;
    EXPECT_GE(p.covariance()(6, 6), 0.999 * v) << seconds;
    EXPECT_LT(p.predict(x).minus(x).norm(), 1e-9 * seconds);
  }
}

TEST(Preintegration, OnlyTheHeldPartOfASegmentIsUncertain) {
  auto imu = testing::constant(20, {0, 0, 0}, -kGravity);
  Preintegration::Noise noise{testing::noise_free(), {}};
  const NodeState x = level_at_rest();
  const double measured = integrated(imu, x, noise).covariance()(8, 8);
  EXPECT_LT(measured, 1e-11);
  preprocess::ImuSegment late = imu;
  late.samples.erase(late.samples.begin() + 18, late.samples.end() - 1);  // 15 ms are held
  late.measured_end = late.samples[17].t;
  late.held_ns = 3 * testing::kPeriod;
  const double expected =
      wandered_numerically(noise.unmeasured, noise.unmeasured.accel_sigma_m_s2, 0.015);
  EXPECT_NEAR(integrated(late, x, noise).covariance()(8, 8) / expected, 1, 2e-3);
  preprocess::ImuSegment early = imu;
  early.samples.erase(early.samples.begin() + 1, early.samples.begin() + 3);
  early.measured_begin = early.samples[1].t;
  early.held_ns = 3 * testing::kPeriod;
  EXPECT_NEAR(integrated(early, x, noise).covariance()(8, 8) / expected, 1, 2e-3);
}

TEST(Preintegration, AGapBetweenReadingsIsTiedDownAtBothEnds) {
  auto imu = testing::constant(20, {0, 0, 0}, -kGravity);
  imu.samples.erase(imu.samples.begin() + 5, imu.samples.begin() + 15);
  Preintegration::Noise noise{testing::noise_free(), {}};
  const NodeState x = level_at_rest();
  const double half = to_seconds(11 * testing::kPeriod) / 2;
  const double expected =
      2 * wandered_numerically(noise.unmeasured, noise.unmeasured.accel_sigma_m_s2, half);
  EXPECT_NEAR(integrated(imu, x, noise).covariance()(8, 8) / expected, 1, 2e-3);
  EXPECT_LT(integrated(imu, x, noise).predict(x).minus(x).norm(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(IdentityNearItRandomAndNearPi, AtRotation, testing::kRotations);

}  // namespace
}  // namespace holdfast::estimator
