#pragma once

#include <memory>

#include "holdfast/monitor/dual_index.hpp"
#include "holdfast/pipeline/methods/scan_localizer.hpp"

namespace holdfast::pipeline {

/// A localizer whose health is judged by the article's detector (3.4.1). After an anomaly it is
/// LOST. The article searches then, and begins its statistics anew with what was found; without a
/// search it stays so until as many scans in a row as confirm an anomaly are no candidates.
class DualIndexLocalizer : public ScanLocalizer {
 public:
  DualIndexLocalizer(std::unique_ptr<ScanLocalizer> localizer,
                     const monitor::DualIndexConfig& config)
      : localizer_(std::move(localizer)), config_(config), detector_(config) {}

  void add_imu(const ImuSample& sample) override { localizer_->add_imu(sample); }
  StepReport add_scan(const Scan& scan) override;

 private:
  std::unique_ptr<ScanLocalizer> localizer_;
  monitor::DualIndexConfig config_;
  monitor::DualIndexDetector detector_;
  bool lost_ = false;
  int calm_ = 0;  ///< scans in a row without a candidate
};

}  // namespace holdfast::pipeline
