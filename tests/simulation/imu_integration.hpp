#pragma once

#include <vector>

#include "holdfast/core/se3.hpp"
#include "holdfast/core/sensor_data.hpp"

/// A fourth-order integration of IMU samples.
namespace holdfast::simulation::testing {

/// Rotation over two intervals from three rates: Simpson's rule and the first commutator (fourth
/// order Magnus expansion), and over the first of the two from the parabola through the same rates.
inline Eigen::Quaterniond two_steps(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c, double step) {
  return so3::exp(step / 3 * (a + 4 * b + c) + 4 * step * step / 12 * a.cross(c));
}
inline Eigen::Quaterniond one_step(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                   const Eigen::Vector3d& c, double step) {
  return so3::exp(step / 12 * (5 * a + 8 * b - c) + step * step / 12 * a.cross(b));
}

struct Integrated {
  SE3 pose;
  Eigen::Vector3d velocity;
};

/// The state at the last of an odd number of samples `step` seconds apart.
inline Integrated integrate(const std::vector<ImuSample>& imu, Integrated state,
                            const Eigen::Vector3d& g, double step) {
  for (std::size_t i = 0; i + 2 < imu.size(); i += 2) {
    const auto& [t0, w0, f0] = imu[i];
    const auto& [t1, w1, f1] = imu[i + 1];
    const auto& [t2, w2, f2] = imu[i + 2];
    const Eigen::Quaterniond middle = state.pose.rotation * one_step(w0, w1, w2, step);
    const Eigen::Quaterniond end = (state.pose.rotation * two_steps(w0, w1, w2, step)).normalized();
    const Eigen::Vector3d a0 = state.pose.rotation * f0 + g;
    const Eigen::Vector3d a1 = middle * f1 + g;
    const Eigen::Vector3d a2 = end * f2 + g;
    const double h = 2 * step;
    state.pose.translation += h * state.velocity + h * h / 6 * (a0 + 2 * a1);
    state.velocity += h / 6 * (a0 + 4 * a1 + a2);
    state.pose.rotation = end;
  }
  return state;
}

}  // namespace holdfast::simulation::testing
