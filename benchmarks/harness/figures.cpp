#include "benchmarks/harness/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "evaluation/result/number_text.hpp"

namespace holdfast::benchmarks {

Distribution distribution_of(const std::vector<double>& values) {
  const auto at = [&](double q) { return evaluation::quantile(values, q); };
  return {at(0.5), at(0.95), at(0.99), at(0.999), at(1.0)};
}

nlohmann::ordered_json json_of(const Distribution& d) {
  return {{"p50", known(d.p50)},
          {"p95", known(d.p95)},
          {"p99", known(d.p99)},
          {"p99.9", known(d.p999)},
          {"max", known(d.max)}};
}

MedianAndWorst median_and_worst(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  if (values.empty()) return {evaluation::kNotKnown, evaluation::kNotKnown};
  return {evaluation::median(values), largest(values)};
}

double smallest(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

std::string ratio_text(double ratio) {
  if (!std::isfinite(ratio)) return "-";
  const int decimals = ratio < 9.995 ? 2 : ratio < 99.95 ? 1 : 0;
  return fmt::format("{:.{}f} x", ratio, decimals);
}

std::string interval_text(const evaluation::Share& share) {
  if (share.of == 0) return "-";
  const evaluation::Interval i = evaluation::interval_95(share);
  return fmt::format("{} [{}, {}]", evaluation::share_text(share.value()),
                     evaluation::share_text(i.low), evaluation::share_text(i.high));
}

std::string memory_text(double megabytes) {
  return std::isfinite(megabytes) ? fmt::format("{:.0f} MB", megabytes) : "-";
}

nlohmann::ordered_json known(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace holdfast::benchmarks
