#include "holdfast/filter/filter_state.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <functional>
#include <numbers>

#include "holdfast/core/random.hpp"
#include "tests/tolerances.hpp"

namespace holdfast::filter {
namespace {

using Eigen::Vector3d;

constexpr TimeNs kStart = 1'700'000'000 * kSecond;
constexpr TimeNs kPeriod = 5'000'000;
const Vector3d kGravity(0, 0, -9.81);

Vector3d random_vector(RandomStream& random, double size) {
  return size * Vector3d(random.normal(), random.normal(), random.normal());
}

/// `n` intervals of readings.
preprocess::ImuSegment readings(int n, const std::function<ImuSample(double)>& at_seconds,
                                TimeNs period = kPeriod) {
  preprocess::ImuSegment segment;
  for (int i = 0; i <= n; ++i) {
    ImuSample sample = at_seconds(to_seconds(i * period));
    sample.t = kStart + i * period;
    segment.samples.push_back(sample);
  }
  return segment;
}

preprocess::ImuSegment constant(int n, const Vector3d& gyro, const Vector3d& accel,
                                TimeNs period = kPeriod) {
  return readings(
      n,
      [&](double) {
        return ImuSample{0, gyro, accel};
      },
      period);
}

ImuNoiseConfig without_noise() { return {0, 0, 0, 0}; }

FilterState at_rest() {
  FilterState state;
  state.t = kStart;
  state.P.setZero();
  return state;
}

/// The rotations at which everything that has to do with rotation is tested.
class AtRotation : public ::testing::TestWithParam<std::array<double, 3>> {
 protected:
  Eigen::Quaterniond rotation() const {
    return so3::exp({GetParam()[0], GetParam()[1], GetParam()[2]});
  }
  FilterState state() const {
    RandomStream random(1, "state");
    FilterState s = at_rest();
    s.T_map_body = {rotation(), random_vector(random, 5)};
    s.v_map = random_vector(random, 2);
    s.accel_bias = random_vector(random, 0.1);
    s.gyro_bias = random_vector(random, 0.02);
    return s;
  }
};

TEST_P(AtRotation, MinusIsTheInverseOfAdd) {
  RandomStream random(2, "errors");
  const FilterState x = state();
  EXPECT_LT(x.minus(x).norm(), tolerances::kRounding);
  for (const double size : {1e-9, 1e-3, 0.5}) {
    Vector15d e;
    for (int i = 0; i < 15; ++i) e[i] = random.normal(0, size);
    FilterState y = x;
    y.add(e);
    // Positions of about 10 m cost another factor.
    EXPECT_LT((y.minus(x) - e).norm(), 10 * tolerances::kRounding) << size;
  }
}

TEST_P(AtRotation, RotationIsPerturbedOnTheRightAndPositionInTheMap) {
  const FilterState x = state();
  Vector15d e = Vector15d::Zero();
  e.segment<3>(FilterState::kP) = Vector3d(1, 2, 3);
  e.segment<3>(FilterState::kR) = Vector3d(0.1, -0.2, 0.3);
  FilterState y = x;
  y.add(e);
  EXPECT_EQ(y.T_map_body.translation, x.T_map_body.translation + Vector3d(1, 2, 3));
  EXPECT_LT(
      so3::angle_between(y.T_map_body.rotation, x.T_map_body.rotation * so3::exp({0.1, -0.2, 0.3})),
      tolerances::kNearPi);
}

TEST_P(AtRotation, OneStepCarriesTheCovarianceLikeFiniteDifferences) {
  const FilterState x = state();
  const Vector3d rate(0.7, -0.4, 0.9);
  const Vector3d force(0.8, -0.5, 9.6);
  const auto imu = constant(1, rate, force);
  const auto propagated = [&](FilterState s) {
    propagate(s, imu, kGravity, without_noise());
    return s;
  };
  const FilterState x1 = propagated(x);
  Matrix15d F_numeric, F;
  for (int i = 0; i < 15; ++i) {
    const Vector15d step = tolerances::kDifferenceStep * Vector15d::Unit(i);
    FilterState plus = x;
    FilterState minus = x;
    plus.add(step);
    minus.add(-step);
    F_numeric.col(i) = (propagated(plus).minus(x1) - propagated(minus).minus(x1)) /
                       (2 * tolerances::kDifferenceStep);
    // F e e^T F^T is the square of a column, whose own entry is about one.
    FilterState unit = x;
    unit.P = Vector15d::Unit(i) * Vector15d::Unit(i).transpose();
    unit = propagated(unit);
    F.col(i) = unit.P.col(i) / std::sqrt(unit.P(i, i));
  }
  // To first order: what an error of rotation or of the rate does within the step is left out, half
  // a step of the turn and of the specific force.
  const double dt = to_seconds(kPeriod);
  const double second_order =
      0.5 * dt * dt * (force.norm() * (1 + rate.norm()) + rate.squaredNorm());
  EXPECT_LT((F - F_numeric).cwiseAbs().maxCoeff(),
            second_order + tolerances::difference_error(1.0, 100 * tolerances::kRounding));
  // The test can tell: the largest terms are far above the tolerance.
  EXPECT_GT((F_numeric - Matrix15d::Identity()).cwiseAbs().maxCoeff(), 50 * second_order);
}

INSTANTIATE_TEST_SUITE_P(IdentityNearItRandomAndNearPi, AtRotation,
                         ::testing::Values(std::array{0.0, 0.0, 0.0}, std::array{1e-5, -2e-5, 0.0},
                                           std::array{0.4, -0.9, 1.3},
                                           std::array{0.0, std::numbers::pi - 1e-6, 0.0}));

TEST(Propagate, FreeFallIsAParabola) {
  FilterState state = at_rest();
  state.v_map = {1, 2, 3};
  state.T_map_body.rotation = so3::exp({0.3, 0.2, 0.1});
  propagate(state, constant(200, {0, 0, 0}, {0, 0, 0}), kGravity, without_noise());
  // 200 steps of a few roundings of values up to 5.
  const double tolerance = 200 * 5 * tolerances::kRounding;
  EXPECT_EQ(state.t, kStart + kSecond);
  EXPECT_LT((state.T_map_body.translation - (Vector3d(1, 2, 3) + 0.5 * kGravity)).norm(),
            tolerance);
  EXPECT_LT((state.v_map - (Vector3d(1, 2, 3) + kGravity)).norm(), tolerance);
}

TEST(Propagate, AtRestAnyAttitudeStays) {
  for (const Vector3d& turn : {Vector3d(0, 0, 0), Vector3d(0.5, -0.8, 2.0), Vector3d(3.1, 0, 0)}) {
    FilterState state = at_rest();
    state.T_map_body.rotation = so3::exp(turn);
    const Vector3d accel = state.T_map_body.rotation.conjugate() * -kGravity;
    propagate(state, constant(200, {0, 0, 0}, accel), kGravity, without_noise());
    EXPECT_LT(state.T_map_body.translation.norm(), 200 * 10 * tolerances::kRounding);
    EXPECT_LT(state.v_map.norm(), 200 * 10 * tolerances::kRounding);
  }
}

TEST(Propagate, GravityIsTheMapsOwn) {
  const Vector3d tilted(0.7, -0.3, -9.78);
  FilterState state = at_rest();
  propagate(state, constant(200, {0, 0, 0}, -tilted), tilted, without_noise());
  EXPECT_LT(state.T_map_body.translation.norm(), 200 * 10 * tolerances::kRounding);
}

TEST(Propagate, BiasesAreTakenOff) {
  FilterState state = at_rest();
  state.gyro_bias = {0.01, -0.02, 0.03};
  state.accel_bias = {0.1, 0.2, -0.3};
  propagate(state, constant(200, state.gyro_bias, state.accel_bias - kGravity), kGravity,
            without_noise());
  EXPECT_LT(state.T_map_body.translation.norm(), 200 * 10 * tolerances::kRounding);
  EXPECT_LT(so3::angle_between(state.T_map_body.rotation, Eigen::Quaterniond::Identity()),
            200 * tolerances::kRounding);
}

TEST(Propagate, ACircleComesBackToItsStart) {
  // A whole turn in 5 s at 2 m/s.
  const double w = 2 * std::numbers::pi / 5;
  const Vector3d forward(2.0, 0, 0);
  const Vector3d accel = Vector3d(0, 0, w).cross(forward) - kGravity;
  FilterState state = at_rest();
  state.v_map = forward;
  propagate(state, constant(1000, {0, 0, w}, accel), kGravity, without_noise());
  // The midpoint rule makes the chord of an acceleration's turn: (w dt)^2 / 24 too much of it, and
  // in position the same share of w v dt^2 / 2 for each step.
  const double share = std::pow(w * 0.005, 2) / 24;
  const double radius = forward.x() / w;
  EXPECT_LT(state.T_map_body.translation.norm(), 2 * 2 * std::numbers::pi * radius * share * 2);
  EXPECT_LT((state.v_map - forward).norm(), 2 * std::numbers::pi * forward.x() * share * 2);
  EXPECT_LT(so3::angle_between(state.T_map_body.rotation, Eigen::Quaterniond::Identity()),
            1000 * tolerances::kRounding);
}

TEST(Propagate, WhiteNoiseGrowsTheCovarianceAsInClosedForm) {
  // Without specific force and rate nothing couples: variances of rotation and velocity grow with
  // density^2 t, that of the position with density^2 t^3 / 3.
  ImuNoiseConfig noise;
  noise.gyro_noise_density = 0.01;
  noise.accel_noise_density = 0.1;
  noise.gyro_bias_walk = 0;
  noise.accel_bias_walk = 0;
  FilterState state = at_rest();
  constexpr int kSteps = 400;
  propagate(state, constant(kSteps, {0, 0, 0}, {0, 0, 0}), Vector3d::Zero(), noise);
  const double t = 0.005 * kSteps;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(state.P(FilterState::kR + i, FilterState::kR + i), 1e-4 * t, 1e-4 * t * 1e-9);
    EXPECT_NEAR(state.P(FilterState::kV + i, FilterState::kV + i), 1e-2 * t, 1e-2 * t * 1e-9);
    // Noise that comes at the end of each step: lower by 3 / (2 n).
    EXPECT_NEAR(state.P(FilterState::kP + i, FilterState::kP + i), 1e-2 * t * t * t / 3,
                1e-2 * t * t * t / 3 * 2.0 / kSteps);
  }
}

TEST(Propagate, BiasWalksGrowTheCovarianceOfTheBiases) {
  ImuNoiseConfig noise{0, 0, 0.02, 0.3};
  FilterState state = at_rest();
  propagate(state, constant(200, {0, 0, 0}, {0, 0, 0}), Vector3d::Zero(), noise);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(state.P(FilterState::kBg + i, FilterState::kBg + i), 4e-4, 4e-13);
    EXPECT_NEAR(state.P(FilterState::kBa + i, FilterState::kBa + i), 9e-2, 9e-11);
  }
}

TEST(Propagate, TheCovarianceStaysSymmetricAndPositive) {
  RandomStream random(3, "imu");
  FilterState state = at_rest();
  state.P = 0.01 * Matrix15d::Identity();
  const auto imu = readings(2000, [&](double) {
    return ImuSample{0, random_vector(random, 1.0), random_vector(random, 5.0) - kGravity};
  });
  propagate(state, imu, kGravity, ImuNoiseConfig{});
  const double scale = state.P.cwiseAbs().maxCoeff();
  EXPECT_LT((state.P - state.P.transpose()).cwiseAbs().maxCoeff(),
            2000 * tolerances::kRounding * scale);
  const Eigen::SelfAdjointEigenSolver<Matrix15d> solver(state.P);
  EXPECT_GT(solver.eigenvalues()[0], 0);
}

TEST(Propagate, AnEmptySpanChangesNothing) {
  FilterState state = at_rest();
  state.v_map = {1, 1, 1};
  state.P = Matrix15d::Identity();
  const FilterState before = state;
  propagate(state, constant(0, {1, 1, 1}, {1, 1, 1}), kGravity, ImuNoiseConfig{});
  EXPECT_EQ(state.P, before.P);
  EXPECT_EQ(state.minus(before).norm(), 0);
  propagate(state, {}, kGravity, ImuNoiseConfig{});
  EXPECT_EQ(state.t, kStart);
}

}  // namespace
}  // namespace holdfast::filter
