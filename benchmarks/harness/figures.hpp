#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/statistics.hpp"

/// Figures as they enter tables and JSON.
namespace holdfast::benchmarks {

/// Times in ms of many steps.
struct Distribution {
  double p50 = 0, p95 = 0, p99 = 0, p999 = 0, max = 0;
};

/// All NaN for no values.
Distribution distribution_of(const std::vector<double>& values);

/// {"p50": ..., "p95": ..., "p99": ..., "p99.9": ..., "max": ...}.
nlohmann::ordered_json json_of(const Distribution& distribution);

/// Of one figure over many drives. What is not known (NaN) is no figure; what failed (infinite) is
/// the worst. Both NaN for no figures.
struct MedianAndWorst {
  double median = 0, worst = 0;
};
MedianAndWorst median_and_worst(std::vector<double> values);

/// The same of `figure(drive)` over drives.
template <class Drive, class Figure>
MedianAndWorst median_and_worst(const std::vector<Drive>& drives, const Figure& figure) {
  std::vector<double> values;
  for (const Drive& drive : drives) values.push_back(figure(drive));
  return median_and_worst(std::move(values));
}

/// Of at least one value.
double smallest(const std::vector<double>& values);
double largest(const std::vector<double>& values);

/// "11.7 x" with three digits; "-" for what is not known.
std::string ratio_text(double ratio);

/// "0.98 [0.95, 0.99]": a share and its 95 % interval; "-" of nothing.
std::string interval_text(const evaluation::Share& share);

/// "143 MB".
std::string memory_text(double megabytes);

/// A number, or null for what is not known or infinite.
nlohmann::ordered_json known(double value);

}  // namespace holdfast::benchmarks
