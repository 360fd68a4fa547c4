#pragma once

#include "holdfast/filter/scan_update.hpp"

namespace holdfast::filter {

/// The pose and what else the residuals of a scan depend on, at the scan's last point.
struct MatchState {
  SE3 T_map_body;
  Eigen::Vector3d v_map = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d gravity_map = Eigen::Vector3d(0, 0, -9.81);
};

/// Matches one scan to the prior map again and again while an optimisation moves its pose: deskews
/// and pairs the points anew only where the state has moved so far that it matters.
class ScanMatch {
 public:
  ScanMatch(const map::PriorMap& map, const SelectedScan& scan, const UpdateOptions& options,
            WorkerPool& pool, UpdateWorkspace& work, StageClock* clock)
      : map_(map), scan_(scan), options_(options), pool_(pool), work_(work), clock_(clock) {}

  /// Normal equations at `x`, softened by the map's own error. The robust loss starts wide and
  /// narrows from call to call: kCalls calls until it is as narrow as the options say.
  static constexpr int kCalls = 3;
  const registration::NormalEquations& linearise(const MatchState& x);

  /// The equations of the last call without the map's own error.
  const registration::NormalEquations& raw() const { return raw_; }

 private:
  void deskew(const MatchState& x);
  void pair(const MatchState& x);
  bool is_stale(const MatchState& x) const;
  void book(Stage stage);

  const map::PriorMap& map_;
  const SelectedScan& scan_;
  const UpdateOptions& options_;
  WorkerPool& pool_;
  UpdateWorkspace& work_;
  StageClock* clock_;
  MatchState deskewed_;
  SE3 paired_;
  int calls_ = 0;
  registration::NormalEquations raw_;
  registration::NormalEquations softened_;
};

}  // namespace holdfast::filter
