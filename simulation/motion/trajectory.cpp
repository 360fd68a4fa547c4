#include "simulation/motion/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace holdfast::simulation {
namespace {

constexpr int kDegree = 5;
constexpr int kBefore = 2;  // control poses before the knot at or before t that still act at t
constexpr int kAfter = 3;

struct Weights {
  std::array<double, kDegree + 1> value{};
  std::array<double, kDegree + 1> first{};   // per knot
  std::array<double, kDegree + 1> second{};  // per knot^2
};

/// Weights of the six control poses around u in [0, 1), by the Cox-de Boor recursion for uniform
/// knots: w_d[j] = ((u + d - j) w_{d-1}[j-1] + (1 - u + j) w_{d-1}[j]) / d, and derivatives as
/// differences of the bases one and two degrees lower.
Weights spline_weights(double u) {
  std::array<std::array<double, kDegree + 3>, kDegree + 1> w{};  // w[d][j + 2]: zeros on both sides
  w[0][2] = 1;
  for (int d = 1; d <= kDegree; ++d) {
    for (int j = 0; j <= d; ++j) {
      w[d][j + 2] = ((u + d - j) * w[d - 1][j + 1] + (1 - u + j) * w[d - 1][j + 2]) / d;
    }
  }
  Weights out;
  for (int j = 0; j <= kDegree; ++j) {
    out.value[j] = w[kDegree][j + 2];
    out.first[j] = w[kDegree - 1][j + 1] - w[kDegree - 1][j + 2];
    out.second[j] = w[kDegree - 2][j] - 2 * w[kDegree - 2][j + 1] + w[kDegree - 2][j + 2];
  }
  return out;
}

/// Body rates of R = Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Vector3d body_rates(double pitch, double roll, const Eigen::Vector3d& ypr_rate) {
  const double yaw_rate = ypr_rate[0];
  const double pitch_rate = ypr_rate[1];
  const double cos_pitch = std::cos(pitch);
  return {ypr_rate[2] - yaw_rate * std::sin(pitch),
          pitch_rate * std::cos(roll) + yaw_rate * std::sin(roll) * cos_pitch,
          -pitch_rate * std::sin(roll) + yaw_rate * std::cos(roll) * cos_pitch};
}

}  // namespace

Eigen::Quaterniond rotation_of(const PoseVector& pose) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return AngleAxisd(pose[3], Vector3d::UnitZ()) * AngleAxisd(pose[4], Vector3d::UnitY()) *
         AngleAxisd(pose[5], Vector3d::UnitX());
}

Trajectory::Trajectory(TimeNs begin, TimeNs knot, std::vector<PoseVector> control)
    : begin_(begin), knot_(knot), control_(std::move(control)) {
  assert(knot_ > 0);
  assert(control_.size() > kDegree);
}

Trajectory::Values Trajectory::values_at(TimeNs t) const {
  const TimeNs last = static_cast<TimeNs>(control_.size()) - 1 - kAfter;
  t = std::clamp(t - begin_, kBefore * knot_, last * knot_ + knot_ - 1);
  const TimeNs i = t / knot_;
  const double dt = to_seconds(knot_);
  const Weights w = spline_weights(static_cast<double>(t - i * knot_) / static_cast<double>(knot_));
  Values out{PoseVector::Zero(), PoseVector::Zero(), PoseVector::Zero()};
  for (int j = 0; j <= kDegree; ++j) {
    const PoseVector& p = control_[static_cast<std::size_t>(i - kBefore + j)];
    out.pose += w.value[j] * p;
    out.rate += (w.first[j] / dt) * p;
    out.acceleration += (w.second[j] / (dt * dt)) * p;
  }
  return out;
}

MotionState Trajectory::at(TimeNs t) const {
  const Values v = values_at(t);
  return {{rotation_of(v.pose), v.pose.head<3>()},
          v.rate.head<3>(),
          v.acceleration.head<3>(),
          body_rates(v.pose[4], v.pose[5], v.rate.tail<3>())};
}

}  // namespace holdfast::simulation
