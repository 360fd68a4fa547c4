#include "simulation/motion/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "holdfast/core/random.hpp"
#include "tests/tolerances.hpp"

namespace holdfast::simulation {
namespace {

constexpr TimeNs kKnot = kSecond / 20;

std::vector<PoseVector> random_controls(std::size_t n) {
  RandomStream random(3, "controls");
  std::vector<PoseVector> controls(n);
  for (auto& pose : controls) {
    for (int k = 0; k < 6; ++k) pose[k] = (k < 3 ? 0.05 : 0.02) * random.normal();
    pose[4] += 0.3;
  }
  return controls;
}

// A spline of evenly spaced control values on a line is that line, at any time.
TEST(Trajectory, ReproducesSteadyMotionExactly) {
  PoseVector rate;
  rate << 1.2, -0.4, 0.1, 0.5, 0, 0;
  std::vector<PoseVector> controls;
  for (int i = 0; i < 40; ++i) controls.push_back(0.05 * i * rate);
  const Trajectory trajectory(0, kKnot, controls);
  for (TimeNs t = 2 * kKnot; t < 36 * kKnot; t += 3'217'000) {
    const MotionState state = trajectory.at(t);
    EXPECT_NEAR((state.T_map_body.translation - to_seconds(t) * rate.head<3>()).norm(), 0, 1e-14);
    EXPECT_NEAR((state.v_map - rate.head<3>()).norm(), 0, 1e-12);
    EXPECT_NEAR(state.a_map.norm(), 0, 1e-10);
    EXPECT_NEAR((state.omega_body - Eigen::Vector3d(0, 0, 0.5)).norm(), 0, 1e-12);
  }
}

/// Bound of the derivative of the given order: a spline's derivative is a mean of the differences
/// of its control values, divided by the knot.
double derivative_bound(std::vector<PoseVector> controls, int order) {
  for (int k = 0; k < order; ++k) {
    for (std::size_t i = 0; i + 1 < controls.size(); ++i) {
      controls[i] = (controls[i + 1] - controls[i]) / to_seconds(kKnot);
    }
    controls.pop_back();
  }
  double bound = 0;
  for (const PoseVector& pose : controls) bound = std::max(bound, pose.norm());
  return bound;
}

TEST(Trajectory, HasTheDerivativesOfItsValues) {
  const auto controls = random_controls(60);
  const Trajectory trajectory(0, kKnot, controls);
  constexpr TimeNs kStep = 100'000;
  const double h = to_seconds(kStep);
  const double third = derivative_bound(controls, 3);
  const double fourth = derivative_bound(controls, 4);
  for (TimeNs t = 3 * kKnot; t < 55 * kKnot; t += 7'770'000) {
    const MotionState now = trajectory.at(t);
    const MotionState before = trajectory.at(t - kStep);
    const MotionState after = trajectory.at(t + kStep);
    const Eigen::Vector3d v =
        (after.T_map_body.translation - before.T_map_body.translation) / (2 * h);
    const Eigen::Vector3d a = (after.v_map - before.v_map) / (2 * h);
    const Eigen::Vector3d turned =
        so3::log(before.T_map_body.rotation.conjugate() * after.T_map_body.rotation) / (2 * h);
    EXPECT_NEAR((v - now.v_map).norm(), 0, third * h * h / 6 + 1e-11);
    EXPECT_NEAR((a - now.a_map).norm(), 0, fourth * h * h / 6 + 1e-9);
    // Angles of 0.1 rad and their products make the rotation vector's third derivative less than
    // twice that of the angles.
    EXPECT_NEAR((turned - now.omega_body).norm(), 0, 2 * third * h * h / 6 + 1e-10);
  }
}

TEST(Trajectory, IsTwiceContinuouslyDifferentiableAtItsKnots) {
  const auto controls = random_controls(60);
  const Trajectory trajectory(0, kKnot, controls);
  const double second = derivative_bound(controls, 2);
  const double third = derivative_bound(controls, 3);
  for (TimeNs knot = 3 * kKnot; knot < 56 * kKnot; knot += kKnot) {
    const auto before = trajectory.values_at(knot - 1);  // a nanosecond earlier
    const auto after = trajectory.values_at(knot);
    EXPECT_NEAR((after.acceleration - before.acceleration).norm(), 0, third * 1e-9 + 1e-10);
    EXPECT_NEAR((after.rate - before.rate).norm(), 0, second * 1e-9 + 1e-11);
  }
}

TEST(Trajectory, StandsStillOutsideItsTimes) {
  const Trajectory trajectory(0, kKnot, random_controls(20));
  EXPECT_EQ(trajectory.values_at(-kSecond).pose, trajectory.values_at(2 * kKnot).pose);
  EXPECT_EQ(trajectory.values_at(kSecond).pose, trajectory.values_at(17 * kKnot - 1).pose);
}

}  // namespace
}  // namespace holdfast::simulation
