#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string_view>

#include "holdfast/core/random.hpp"

namespace holdfast::simulation {

/// Bias instability: noise whose power falls with the frequency (1/f) on each of three axes, as a
/// sum of stationary first-order Gauss-Markov processes of equal variance with correlation times of
/// 1, 4, 16 ... 4096 s. Processes of variance s^2 whose correlation times T are a factor r apart
/// have the one-sided density s^2 / (f ln r) (the integral of 4 s^2 T / (1 + (2 pi f T)^2) over
/// ln T), and the Allan variance of h / f is 2 ln(2) h: with r = 4 the deviation's floor is s. It
/// is flat within 5 % from 8 s to 1000 s (tests/simulation/sensors/imu_allan_test.cpp).
class FlickerBias {
 public:
  static constexpr std::size_t kProcesses = 7;
  static constexpr double kShortestS = 1;
  static constexpr double kRatio = 4;

  /// `floor`: level of the Allan deviation, in the unit of the sensor; zero draws nothing.
  FlickerBias(double floor, double interval_s, std::uint64_t seed, std::string_view stream);

  /// The bias of the next sample.
  Eigen::Vector3d next();

  /// Allan variance of the sum at the averaging time `tau_s` for a floor of 1, in closed form.
  static double allan_variance(double tau_s);

 private:
  struct Process {
    double keep = 0;  ///< share of its value after one interval
    double gain = 0;  ///< of the normal value that is added
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
  };
  double floor_;
  RandomStream random_;
  std::array<Process, kProcesses> processes_;
};

}  // namespace holdfast::simulation
