#pragma once

#include <cstddef>
#include <vector>

#include "evaluation/scan_list.hpp"

namespace holdfast::evaluation {

/// Drift over a given length of the true way (relative pose error). Alignment does not change it.
struct RelativeError {
  double length_m = 0;
  std::size_t segments = 0;  ///< 0: the drive is shorter than this, figures are NaN
  double trans_rmse_m = kNotKnown;
  double rot_rmse_deg = kNotKnown;
  double drift_percent = kNotKnown;  ///< mean of translation error / true way, times 100
};

/// From every claimed scan to the first claimed scan at least `length_m` of true way later:
/// the error of the relative pose, (T_ti^-1 T_tj)^-1 (T_ei^-1 T_ej). Segments across a teleport, a
/// gap of the truth or a new odom_epoch (if `break_at_epochs`) are left out.
RelativeError relative_error(const std::vector<ScanRecord>& scans, double length_m,
                             bool break_at_epochs);

}  // namespace holdfast::evaluation
