#include "holdfast/pipeline/methods/feature_selection.hpp"

#include <algorithm>

#include "holdfast/core/stage_clock.hpp"

namespace holdfast::pipeline {

StepReport FeatureSelection::add_scan(const Scan& scan) {
  StageTimes times;
  {
    StageClock clock(times);
    reduce(scan);
  }
  StepReport report = method_->add_scan(reduced_);
  report.times.ms[static_cast<std::size_t>(Stage::kSelect)] += times.total_ms;
  report.times.total_ms += times.total_ms;
  report.times.wall_ms += times.wall_ms;
  return report;
}

/// The points keep their order: of the log, not of the features.
void FeatureSelection::reduce(const Scan& scan) {
  extractor_.extract(scan, found_);
  chosen_.clear();
  for (const auto* kind : {&found_.edges, &found_.planes}) {
    for (const features::Feature& feature : *kind) chosen_.push_back(feature.index);
  }
  std::sort(chosen_.begin(), chosen_.end());
  chosen_.erase(std::unique(chosen_.begin(), chosen_.end()), chosen_.end());
  reduced_.stamp = scan.stamp;
  reduced_.end_time = scan.end_time;
  reduced_.has_ring = scan.has_ring;
  reduced_.has_point_times = scan.has_point_times;
  reduced_.invalid_points = scan.invalid_points;
  reduced_.points.clear();
  for (const std::uint32_t i : chosen_) reduced_.points.push_back(scan.points[i]);
}

}  // namespace holdfast::pipeline
