#pragma once

#include "holdfast/core/sensor_data.hpp"
#include "holdfast/core/step_report.hpp"

namespace holdfast::pipeline {

/// A method of localization: readings and scans in, a report for each scan out.
class ScanLocalizer {
 public:
  virtual ~ScanLocalizer() = default;
  /// Readings in ascending order.
  virtual void add_imu(const ImuSample& sample) = 0;
  /// The pose at the scan's last point, after the readings up to it.
  virtual StepReport add_scan(const Scan& scan) = 0;
};

}  // namespace holdfast::pipeline
