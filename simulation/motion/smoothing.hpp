#pragma once

#include <cstddef>
#include <vector>

/// Smoothing of a series of samples before it becomes the control values of a spline.
namespace holdfast::simulation {

inline constexpr std::size_t kMeanTicks = 7;
inline constexpr std::size_t kMeanPasses = 3;

/// How many samples `smoothed` takes away on each side.
inline constexpr std::size_t kMeanReach = kMeanPasses * (kMeanTicks / 2);

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
