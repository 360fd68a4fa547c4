#pragma once

#include "baselines/map_filter.hpp"
#include "holdfast/pipeline/config.hpp"
#include "holdfast/pipeline/methods/scan_localizer.hpp"

namespace holdfast::pipeline {

/// map_filter's share of a configuration. GraphLocalizer starts with the same.
baselines::MapFilter::Setup filter_setup(const Config& config, int threads = 1);

/// The baseline as a method.
class MapFilterMethod : public ScanLocalizer {
 public:
  MapFilterMethod(map::PriorMap map, const baselines::MapFilter::Setup& setup,
                  const SE3& T_map_body)
      : filter_(std::move(map), setup, T_map_body) {}

  void add_imu(const ImuSample& sample) override { filter_.add_imu(sample); }
  StepReport add_scan(const Scan& scan) override { return filter_.add_scan(scan); }

 private:
  baselines::MapFilter filter_;
};

}  // namespace holdfast::pipeline
