#pragma once

#include <memory>

#include "baselines/map_filter.hpp"
#include "holdfast/features/features.hpp"
#include "holdfast/pipeline/methods/scan_localizer.hpp"
#include "holdfast/registration/fit_at_query.hpp"

namespace holdfast::pipeline {

/// The map matching of the article as printed (3.2.2): features of the deskewed scan against lines
/// and planes that are fitted at query time, from the pose that the IMU predicts. The print says
/// nothing of the uncertainty of the pose found: it corrects the prediction as a measurement with
/// the standard deviation of one range, and with that at a lever of 10 m as the rotation's. Starts
/// as `map_filter` does. Slow by design: kept for the article's own figures.
class QueryMatching : public ScanLocalizer {
 public:
  struct Setup {
    baselines::MapFilter::Setup start;  ///< noise and limits; and the start itself
    features::FeatureConfig features;
    registration::FitAtQueryConfig matching;
  };

  /// `T_map_body` is the pose at the end of the first scan, to within Setup::start. Reads all
  /// points of the map; errors are those of its files.
  static Result<std::unique_ptr<ScanLocalizer>> create(map::PriorMap map, const Setup& setup,
                                                       const SE3& T_map_body);

  void add_imu(const ImuSample& sample) override;
  StepReport add_scan(const Scan& scan) override;

 private:
  QueryMatching(map::PriorMap map, registration::FeatureClouds clouds, const Setup& setup,
                const SE3& T_map_body);
  void step(const Scan& scan, StageClock& clock, StepReport& report);
  void deskew(const Scan& scan);
  registration::FitAtQueryResult match() const;
  void correct(const SE3& measured);
  void describe(const registration::FitAtQueryResult& found, StepReport& report) const;
  void judge(bool valid, StepReport& report) const;

  Setup setup_;
  Eigen::Vector3d gravity_map_;
  Eigen::Vector3d origin_;  ///< of the clouds, in the map frame
  baselines::MapFilter start_;
  bool started_ = false;
  registration::FitAtQuery matcher_;
  features::FeatureExtractor extractor_;
  features::Features found_;
  preprocess::ImuBuffer imu_;
  preprocess::ImuSegment segment_;
  preprocess::ScanMotion motion_;
  registration::FeatureClouds scan_;  ///< of the newest scan, in the body frame of its end
  filter::FilterState state_;
};

}  // namespace holdfast::pipeline
