#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace holdfast::evaluation {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// Error sizes in one figure each; all NaN when nothing was measured.
struct ErrorStatistics {
  double rmse = kNotKnown;
  double mean = kNotKnown;
  double median = kNotKnown;
  double p95 = kNotKnown;
  double max = kNotKnown;
};

/// The value below which the share `q` (0 to 1) of `values` lies, linear between order statistics
/// (Hyndman and Fan's type 7). NaN for no values.
double quantile(std::vector<double> values, double q);
double median(std::vector<double> values);
ErrorStatistics error_statistics(const std::vector<double>& errors);

/// `count` out of `of` scans.
struct Share {
  std::size_t count = 0;
  std::size_t of = 0;

  void add(bool yes) {
    ++of;
    if (yes) ++count;
  }
  /// NaN when `of` is 0.
  double value() const {
    return of == 0 ? kNotKnown : static_cast<double>(count) / static_cast<double>(of);
  }
};

struct Interval {
  double low = kNotKnown;
  double high = kNotKnown;
};

/// 95 % interval of a share by Clopper and Pearson (1934): exact for independent trials; two-sided,
/// but one-sided at 0 and at all (0 of 400 gives [0, 0.0075]). Scans of one drive are not
/// independent, so over few drives the truth is wider.
Interval interval_95(const Share& share);

}  // namespace holdfast::evaluation
