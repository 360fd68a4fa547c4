#pragma once

#include "holdfast/features/features.hpp"
#include "holdfast/features/scan_rows.hpp"

namespace holdfast::features {

/// Mean and standard deviation of the smoothness over a scan.
struct SmoothnessStatistics {
  double mean = 0, sigma = 0;
  std::size_t count = 0;  ///< points that have a smoothness
};

/// Classifies by the smoothness s_i of article 3.2.1, or by its logarithm: edges above
/// mean + edge_sigmas * sigma, planes below mean - plane_sigmas * sigma. Points with fewer than two
/// neighbours on a side along their row (and for the logarithm those that coincide with all of
/// them) have none: `smoothness` holds NaN there. Appends to `out`.
SmoothnessStatistics classify_by_smoothness(const ScanRows& rows, const FeatureConfig& config,
                                            bool logarithmic, std::vector<double>& smoothness,
                                            Features& out);

}  // namespace holdfast::features
