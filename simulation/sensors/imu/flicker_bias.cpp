#include "simulation/sensors/imu/flicker_bias.hpp"

#include <cmath>

#include "simulation/sensors/imu/normal_vector.hpp"

namespace holdfast::simulation {

using Eigen::Vector3d;

FlickerBias::FlickerBias(double floor, double interval_s, std::uint64_t seed,
                         std::string_view stream)
    : floor_(floor), random_(seed, stream) {
  if (floor_ == 0) return;
  double correlation_s = kShortestS;
  for (Process& process : processes_) {
    process.keep = std::exp(-interval_s / correlation_s);
    process.gain = floor_ * std::sqrt(1 - process.keep * process.keep);
    process.value = floor_ * normal_vector(random_);
    correlation_s *= kRatio;
  }
}

Vector3d FlickerBias::next() {
  Vector3d sum = Vector3d::Zero();
  if (floor_ == 0) return sum;
  for (Process& process : processes_) {
    sum += process.value;
    process.value = process.keep * process.value + process.gain * normal_vector(random_);
  }
  return sum;
}

// Of one process: IEEE Std 952-1997, equation C.20, with its q^2 Tc^2 / 2 as the variance.
double FlickerBias::allan_variance(double tau_s) {
  double sum = 0;
  double correlation_s = kShortestS;
  for (std::size_t i = 0; i < kProcesses; ++i) {
    const double x = tau_s / correlation_s;
    sum += 2 / x * (1 - (3 - 4 * std::exp(-x) + std::exp(-2 * x)) / (2 * x));
    correlation_s *= kRatio;
  }
  return sum;
}

}  // namespace holdfast::simulation
