#pragma once

#include "holdfast/filter/filter_state.hpp"
#include "holdfast/filter/scan_match.hpp"

namespace holdfast::filter {

/// Normal equations of a scan by all that its points depend on, in the order of FilterState.
struct SkewEquations {
  Matrix15d H = Matrix15d::Zero();
  Vector15d g = Vector15d::Zero();
};

/// Normal equations of `pairs` by the pose at the end of the scan, and through the skew by the
/// velocity and both biases. A point that was measured a time a before the end stands in the body
/// frame of the end at
///   q - a v + a^2/2 (accel - b_a) + a (gyro - b_g) x q,   to first order in what is uncertain.
/// Robust weights as in registration::linearise.
SkewEquations linearise_with_skew(const registration::Correspondences& pairs,
                                  const SE3& T_anchor_body, double robust_scale);

/// ScanMatch for a robot whose motion is not known from its IMU: while that is silent, or its
/// biases were let go, the skew of a scan depends on the very motion that the scan is to tell.
/// Taken as known, a wrong velocity or rate would move the pose, and the pose the next velocity, to
/// and fro and ever farther. Deskews and pairs anew in each call.
class SkewMatch {
 public:
  SkewMatch(const ScanPairing& map, const SelectedScan& scan, const UpdateOptions& options,
            WorkerPool& pool, UpdateWorkspace& work, StageClock* clock)
      : map_(map), scan_(scan), options_(options), pool_(pool), work_(work), clock_(clock) {}

  /// At `x`, softened by the map's own error; the robust loss narrows from call to call.
  SkewEquations linearise(const MatchState& x);

  /// The equations of the last call without the map's own error, pose and velocity.
  const registration::NormalEquations& raw() const { return raw_; }

 private:
  const ScanPairing& map_;
  const SelectedScan& scan_;
  const UpdateOptions& options_;
  WorkerPool& pool_;
  UpdateWorkspace& work_;
  StageClock* clock_;
  int calls_ = 0;
  registration::NormalEquations raw_;
};

}  // namespace holdfast::filter
