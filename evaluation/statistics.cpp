#include "evaluation/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace holdfast::evaluation {
namespace {

/// Continued fraction of the incomplete beta function (DLMF 8.17.22), by Lentz's method; converges
/// fast for x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  const auto away_from_zero = [](double value) { return std::abs(value) < kTiny ? kTiny : value; };
  double c = 1;
  double d = 1 / away_from_zero(1 - (a + b) * x / (a + 1));
  double fraction = d;
  for (int m = 1; m < 500; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double change = 1;
    for (const double term : {even, odd}) {
      d = 1 / away_from_zero(1 + term * d);
      c = away_from_zero(1 + term / c);
      change = c * d;
      fraction *= change;
    }
    if (std::abs(change - 1) < 1e-14) break;
  }
  return fraction;
}

/// Regularised incomplete beta function I_x(a, b).
double incomplete_beta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double log_front =
      std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x);
  if (x < (a + 1) / (a + b + 2)) return std::exp(log_front) * beta_fraction(a, b, x) / a;
  return 1 - std::exp(log_front) * beta_fraction(b, a, 1 - x) / b;
}

/// P(X <= k) for X binomial with n trials of probability p; k < n.
double binomial_cdf(std::size_t k, std::size_t n, double p) {
  return incomplete_beta(static_cast<double>(n - k), static_cast<double>(k + 1), 1 - p);
}

/// The p in (0, 1) at which the falling function P(X <= k | p) passes `level`.
double solve_for_p(std::size_t k, std::size_t n, double level) {
  double low = 0;
  double high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (binomial_cdf(k, n, middle) > level ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return kNotKnown;
  std::sort(values.begin(), values.end());
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  const double u = place - static_cast<double>(below);
  return (1 - u) * values[below] + u * values[above];
}

double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

ErrorStatistics error_statistics(const std::vector<double>& errors) {
  if (errors.empty()) return {};
  const auto n = static_cast<double>(errors.size());
  ErrorStatistics s;
  s.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / n;
  s.rmse = std::sqrt(std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0) / n);
  s.median = median(errors);
  s.p95 = quantile(errors, 0.95);
  s.max = *std::max_element(errors.begin(), errors.end());
  return s;
}

Interval interval_95(const Share& share) {
  const std::size_t k = share.count;
  const std::size_t n = share.of;
  if (n == 0) return {};
  const bool one_sided = k == 0 || k == n;
  const double tail = one_sided ? 0.05 : 0.025;
  Interval interval{0, 1};
  if (k > 0) interval.low = solve_for_p(k - 1, n, 1 - tail);
  if (k < n) interval.high = solve_for_p(k, n, tail);
  return interval;
}

}  // namespace holdfast::evaluation
