#include "holdfast/features/smoothness.hpp"

#include <cmath>
#include <limits>

namespace holdfast::features {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// s_i of article 3.2.1 for the points of one row: NaN where a neighbour is missing.
void add_row(const Eigen::Vector3f* p, std::size_t n, bool logarithmic, double* s) {
  for (std::size_t i = 0; i < n; ++i) {
    if (i < 2 || i + 2 >= n) {
      s[i] = kNone;
      continue;
    }
    const float sum = (p[i] - p[i - 2]).squaredNorm() + (p[i] - p[i - 1]).squaredNorm() +
                      (p[i] - p[i + 1]).squaredNorm() + (p[i] - p[i + 2]).squaredNorm();
    s[i] = sum / 5.0;
    if (logarithmic) s[i] = s[i] > 0 ? std::log(s[i]) : kNone;
  }
}

SmoothnessStatistics statistics_of(const std::vector<double>& values) {
  SmoothnessStatistics s;
  double sum = 0;
  for (const double v : values) {
    if (std::isnan(v)) continue;
    sum += v;
    ++s.count;
  }
  if (s.count == 0) return s;
  s.mean = sum / static_cast<double>(s.count);
  double squares = 0;
  for (const double v : values) {
    if (!std::isnan(v)) squares += (v - s.mean) * (v - s.mean);
  }
  s.sigma = std::sqrt(squares / static_cast<double>(s.count));
  return s;
}

}  // namespace

SmoothnessStatistics classify_by_smoothness(const ScanRows& rows, const FeatureConfig& config,
                                            bool logarithmic, std::vector<double>& smoothness,
                                            Features& out) {
  smoothness.resize(rows.size());
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const std::size_t begin = rows.begin[row];
    add_row(&rows.points[begin], rows.begin[row + 1] - begin, logarithmic, &smoothness[begin]);
  }
  const SmoothnessStatistics s = statistics_of(smoothness);
  const double edge_above = s.mean + config.edge_sigmas * s.sigma;
  const double plane_below = s.mean - config.plane_sigmas * s.sigma;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    // Comparisons with NaN are false.
    if (smoothness[i] > edge_above) out.edges.push_back({rows.source[i], rows.points[i]});
    if (smoothness[i] < plane_below) out.planes.push_back({rows.source[i], rows.points[i]});
  }
  return s;
}

}  // namespace holdfast::features
