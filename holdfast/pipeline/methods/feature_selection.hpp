#pragma once

#include <memory>

#include "holdfast/features/features.hpp"
#include "holdfast/pipeline/methods/scan_localizer.hpp"

namespace holdfast::pipeline {

/// Hands the edge and planar points of each scan to another method, and nothing else (article
/// 3.2.1). A scan without any comes to it empty. The extraction is booked under Stage::kSelect.
class FeatureSelection : public ScanLocalizer {
 public:
  /// `range_sigma_m` as in lidar.range_sigma_m.
  FeatureSelection(std::unique_ptr<ScanLocalizer> method, const features::FeatureConfig& config,
                   double range_sigma_m)
      : method_(std::move(method)), extractor_(config, range_sigma_m) {}

  void add_imu(const ImuSample& sample) override { method_->add_imu(sample); }
  StepReport add_scan(const Scan& scan) override;

 private:
  void reduce(const Scan& scan);

  std::unique_ptr<ScanLocalizer> method_;
  features::FeatureExtractor extractor_;
  features::Features found_;
  std::vector<std::uint32_t> chosen_;
  Scan reduced_;
};

}  // namespace holdfast::pipeline
