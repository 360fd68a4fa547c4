#pragma once

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <numbers>

#include "holdfast/core/random.hpp"
#include "holdfast/estimator/preintegration.hpp"
#include "tests/tolerances.hpp"

/// Readings and states that the tests of the estimator share.
namespace holdfast::estimator::testing {

using Eigen::Vector3d;

inline const Vector3d kGravity(0, 0, -9.81);
constexpr TimeNs kStart = 1'700'000'000 * kSecond;
constexpr TimeNs kPeriod = 5'000'000;

inline Vector3d random_vector(RandomStream& random, double size) {
  const double x = random.normal(), y = random.normal();
  return size * Vector3d(x, y, random.normal());
}

/// `n` intervals of readings of a function of the seconds since the first.
inline preprocess::ImuSegment readings(int n, const std::function<ImuSample(double)>& at_seconds,
                                       TimeNs start = kStart, TimeNs period = kPeriod) {
  preprocess::ImuSegment segment;
  for (int i = 0; i <= n; ++i) {
    ImuSample sample = at_seconds(to_seconds(i * period));
    sample.t = start + i * period;
    segment.samples.push_back(sample);
  }
  return segment;
}

inline preprocess::ImuSegment constant(int n, const Vector3d& gyro, const Vector3d& accel) {
  return readings(n, [&](double) { return ImuSample{0, gyro, accel}; });
}

/// Readings of a robot thrown about: 0.1 s of rates of 1 rad/s and forces of 10 m/s^2.
inline preprocess::ImuSegment wild(std::uint64_t seed, int n = 20) {
  RandomStream random(seed, "readings");
  return readings(n, [&](double) {
    const Vector3d rate = random_vector(random, 1.0);
    return ImuSample{0, rate, Vector3d(0, 0, 9.81) + random_vector(random, 2.0)};
  });
}

inline NodeState state_at(const Eigen::Quaterniond& rotation, std::uint64_t seed = 1) {
  RandomStream random(seed, "state");
  NodeState s;
  s.t = kStart;
  s.T_map_body = {rotation, random_vector(random, 5)};
  s.v_map = random_vector(random, 2);
  s.accel_bias = random_vector(random, 0.1);
  s.gyro_bias = random_vector(random, 0.02);
  s.gravity_map = kGravity + random_vector(random, 0.1);
  return s;
}

inline Vector18d random_tangent(RandomStream& random, double size) {
  Vector18d d;
  for (int i = 0; i < 18; ++i) d[i] = random.normal(0, size);
  return d;
}

inline filter::ImuNoiseConfig noise_free() { return {0, 0, 0, 0}; }

/// Central differences of a function of a node's tangent.
template <int Rows>
Eigen::Matrix<double, Rows, 18> differences(
    const NodeState& x,
    const std::function<Eigen::Matrix<double, Rows, 1>(const NodeState&)>& function) {
  Eigen::Matrix<double, Rows, 18> J;
  for (int i = 0; i < 18; ++i) {
    const Vector18d step = tolerances::kDifferenceStep * Vector18d::Unit(i);
    NodeState plus = x;
    NodeState minus = x;
    plus.add(step);
    minus.add(-step);
    J.col(i) = (function(plus) - function(minus)) / (2 * tolerances::kDifferenceStep);
  }
  return J;
}

/// The rotations at which everything that has to do with rotation is tested.
class AtRotation : public ::testing::TestWithParam<std::array<double, 3>> {
 protected:
  Eigen::Quaterniond rotation() const {
    return so3::exp({GetParam()[0], GetParam()[1], GetParam()[2]});
  }
};

inline const auto kRotations =
    ::testing::Values(std::array{0.0, 0.0, 0.0}, std::array{1e-5, -2e-5, 0.0},
                      std::array{0.4, -0.9, 1.3}, std::array{0.0, std::numbers::pi - 1e-6, 0.0});

}  // namespace holdfast::estimator::testing
