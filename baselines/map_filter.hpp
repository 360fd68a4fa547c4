#pragma once

#include <optional>

#include "holdfast/core/step_report.hpp"
#include "holdfast/filter/initial_alignment.hpp"
#include "holdfast/filter/matching/point_demand.hpp"
#include "holdfast/filter/rest.hpp"
#include "holdfast/preprocess/scan_selection.hpp"

namespace holdfast::baselines {

using filter::FilterState;
using filter::ImuNoiseConfig;
using filter::InitialUncertainty;
using filter::Matrix15d;
using filter::SelectedScan;
using filter::StartCandidate;
using filter::UpdateOptions;
using filter::UpdateResult;
using filter::UpdateWorkspace;

struct MapFilterConfig {
  double surface_sigma_m = 0.004;
  double robust_scale = 3.0;
  double gate_m = 0.3;
  double min_inlier_share = 0.1;
  double weak_sigma_m = 0.05;
  double lost_sigma_m = 1.0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("surface_sigma_m", self.surface_sigma_m,
          FieldDoc{"least error of a plane of the map, added to its thickness", 1e-4, 1.0});
    visit("robust_scale", self.robust_scale,
          FieldDoc{"residual, in sigmas, at which a point counts a quarter", 0.5, 100.0});
    visit("gate_m", self.gate_m, FieldDoc{"farther planes are no correspondence", 0.01, 5.0});
    visit("min_inlier_share", self.min_inlier_share,
          FieldDoc{"a scan that agrees less with the map is not used", 0.0, 1.0});
    visit("weak_sigma_m", self.weak_sigma_m,
          FieldDoc{"a direction that one scan determines worse than this is weak", 1e-3, 10.0});
    visit("lost_sigma_m", self.lost_sigma_m,
          FieldDoc{"standard deviation of the position beyond which no pose is claimed", 0.05,
                   100.0});
  }
};

/// The baseline that every later module must beat: an iterated error-state Kalman filter with IMU
/// prediction, deskew to the last point and point-to-plane residuals to the precomputed planes of
/// the prior map. No odometry, no window, no search.
class MapFilter {
 public:
  struct Setup {
    MapFilterConfig filter;
    ImuNoiseConfig imu;
    preprocess::ScanSelectionConfig selection;
    InitialUncertainty start;
    double range_sigma_m = 0.02;
    SE3 T_body_lidar;
    int threads = 1;
  };

  /// `T_map_body` is the pose at the end of the first scan, to within Setup::start.
  MapFilter(map::PriorMap map, const Setup& setup, const SE3& T_map_body);

  /// Readings in ascending order; others are refused and counted.
  void add_imu(const ImuSample& sample) { imu_.add(sample); }

  /// The pose at the scan's last point. IMU up to that time should have been added; where it was
  /// not, the last reading is held and the report says for how long.
  StepReport add_scan(const Scan& scan);

  const FilterState& state() const { return state_; }
  /// Is the robot held at rest, until its IMU feels a start?
  bool rests() const { return rest_.is_assumed(); }
  const map::PriorMap& map() const { return map_; }
  /// Of the newest scan, in the body frame at its end.
  const registration::BodyPoints& points() const { return work_.points; }
  /// The map, for whoever goes on from here.
  map::PriorMap take_map() && { return std::move(map_); }
  const preprocess::ImuBuffer& imu() const { return imu_; }

 private:
  void step(const Scan& scan, StageClock& clock, StepReport& report);
  void start(StepReport& report);
  void track(StageClock& clock, StepReport& report);
  bool predict(TimeNs to, StepReport& report);
  UpdateResult correct(StageClock& clock);
  UpdateResult correct_from(int coarsest, const FilterState& predicted, StageClock& clock);
  UpdateResult release_biases(const FilterState& before, const UpdateResult& update,
                              StageClock& clock, StepReport& report);
  void choose_start(StageClock& clock, StepReport& report);
  bool surprised_by_imu(const FilterState& predicted) const;
  void judge(const UpdateResult& update, StepReport& report);
  void describe(const UpdateResult& update, StepReport& report) const;
  UpdateOptions options() const;

  map::PriorMap map_;
  Setup setup_;
  WorkerPool pool_;
  preprocess::ImuBuffer imu_;
  preprocess::ImuSegment segment_;
  UpdateWorkspace work_;
  filter::PointDemand demand_;
  SelectedScan scan_;
  FilterState state_;
  std::vector<StartCandidate> starts_;  ///< after the first scan, until the second has chosen
  filter::Rest rest_;
  std::uint64_t scan_number_ = 0;
  int confirmed_ = 0;  ///< scans in agreement since the start
  bool started_ = false;
  TimeNs start_time_ = 0;
  std::optional<FilterState::Biases> biases_before_hold_;  ///< while the IMU is silent
  TimeNs last_surprise_ = 0;  ///< when the IMU last disagreed with a scan beyond its covariance
};

}  // namespace holdfast::baselines
