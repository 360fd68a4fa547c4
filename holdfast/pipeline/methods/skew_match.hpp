#pragma once

#include "holdfast/estimator/factors/map_factor.hpp"
#include "holdfast/filter/scan_match.hpp"

namespace holdfast::pipeline {

/// Adds the normal equations of `pairs` by all that a scan's points depend on, in the order of
/// filter::FilterState: the pose at its end, and through the skew the velocity and both biases. A
/// point that was measured a time a before the end stands in the body frame of the end at
///   q - a v + a^2/2 (accel - b_a) + a (gyro - b_g) x q,   to first order in what is uncertain.
/// Robust weights as in registration::linearise.
void linearise_with_skew(const registration::Correspondences& pairs, const SE3& T_anchor_body,
                         double robust_scale, filter::Matrix15d& H, filter::Vector15d& g);

/// filter::ScanMatch for a robot whose motion is not known from its IMU: while that is silent, or
/// its biases were let go, the skew of a scan depends on the very motion that the scan is to tell.
/// Taken as known, a wrong velocity or rate would move the pose, and the pose the next velocity, to
/// and fro and ever farther. Deskews and pairs anew in each call.
class SkewMatch {
 public:
  SkewMatch(const map::PriorMap& map, const filter::SelectedScan& scan,
            const filter::UpdateOptions& options, WorkerPool& pool, filter::UpdateWorkspace& work,
            StageClock* clock)
      : map_(map), scan_(scan), options_(options), pool_(pool), work_(work), clock_(clock) {}

  /// At `x`, softened by the map's own error; the robust loss narrows from call to call.
  estimator::MapFactor linearise(const estimator::NodeState& x);

  /// The equations of the last call without the map's own error, pose and velocity.
  const registration::NormalEquations& raw() const { return raw_; }

 private:
  void deskew(const estimator::NodeState& x);

  const map::PriorMap& map_;
  const filter::SelectedScan& scan_;
  const filter::UpdateOptions& options_;
  WorkerPool& pool_;
  filter::UpdateWorkspace& work_;
  StageClock* clock_;
  int calls_ = 0;
  registration::NormalEquations raw_;
};

}  // namespace holdfast::pipeline
