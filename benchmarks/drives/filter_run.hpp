#pragma once

#include <vector>

#include "baselines/map_filter.hpp"
#include "benchmarks/drives/surveyed_drive.hpp"
#include "benchmarks/yardsticks/kd_tree_registration.hpp"
#include "holdfast/core/step_report.hpp"
#include "holdfast/pipeline/methods/map_filter_method.hpp"

namespace holdfast::benchmarks {

/// A scan as map_filter saw it: what it started from, and what came of it.
struct FilteredScan {
  StepReport report;
  std::size_t returns = 0;  ///< points of the scan
  /// The points that the filter chose, deskewed with its prediction. Empty for the first scan,
  /// which is aligned to the initial pose and not tracked.
  registration::BodyPoints points;
  RegistrationStart
      predicted;  ///< of the pose at the last point, with the prediction's information
};

/// Runs map_filter over a log, with one thread, and keeps what it predicted for each scan. The
/// poses are those of `pipeline::Localizer`, bit for bit.
Result<std::vector<FilteredScan>> run_filter(SensorSource& log, const SurveyedDrive& drive);

}  // namespace holdfast::benchmarks
