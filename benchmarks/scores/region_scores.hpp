#pragma once

#include <string>
#include <vector>

#include "evaluation/evaluate.hpp"
#include "simulation/scenario.hpp"

namespace holdfast::benchmarks {

/// A run within one region of its way. All scans after the first seconds count, as in all shares.
struct RegionScore {
  std::string name;
  std::size_t scans = 0;
  double path_m = 0;             ///< true way of the robot within it
  std::vector<double> trans_m;   ///< errors of the claims, of those with truth
  evaluation::Share trusted;     ///< TRACKING or DEGRADED
  evaluation::Share misleading;  ///< trusted, and more than 0.5 m or 5 degrees wrong
};

/// The scans of a run by the region in which the robot truly was; then "elsewhere", those in no
/// region, and "whole drive", all. A scan in two regions counts in the first.
std::vector<RegionScore> score_regions(const std::vector<simulation::Region>& regions,
                                       const std::vector<evaluation::ScanRecord>& series);

}  // namespace holdfast::benchmarks
