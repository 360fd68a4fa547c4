#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

/// Smoothing of a series of samples before it becomes the control values of a spline, and of steps.
namespace holdfast::simulation {

inline constexpr std::size_t kMeanTicks = 7;
inline constexpr std::size_t kMeanPasses = 3;

/// How many samples `smoothed` takes away on each side.
inline constexpr std::size_t kMeanReach = kMeanPasses * (kMeanTicks / 2);

/// 0 below 0, 1 above 1, twice continuously differentiable.
inline double smooth_step(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10 + x * (6 * x - 15));
}

/// Its derivative, and the greatest value of that.
inline double smooth_step_slope(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return 30 * x * x * (1 - x) * (1 - x);
}
inline constexpr double kSmoothStepSteepest = 1.875;

/// Running means of kMeanTicks samples, kMeanPasses times: about a Gaussian with a standard
/// deviation of 3.5 samples.
template <class T>
std::vector<T> smoothed(std::vector<T> series) {
  for (std::size_t pass = 0; pass < kMeanPasses; ++pass) {
    std::vector<T> means;
    for (std::size_t i = 0; i + kMeanTicks <= series.size(); ++i) {
      T sum = series[i];
      for (std::size_t j = 1; j < kMeanTicks; ++j) sum += series[i + j];
      means.push_back(sum / static_cast<double>(kMeanTicks));
    }
    series = std::move(means);
  }
  return series;
}

}  // namespace holdfast::simulation
