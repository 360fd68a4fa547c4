#pragma once

#include <optional>

#include "holdfast/estimator/factors/between_factor.hpp"
#include "holdfast/odometry/odometry.hpp"

namespace holdfast::pipeline {

/// A pose that a map gave, with its covariance in the order [position in the map, rotation on the
/// right].
struct MappedPose {
  SE3 T_map_body;
  estimator::Matrix6d covariance = estimator::Matrix6d::Identity();
};

/// The odometry beside an estimator with a map: what moved since the estimator's last node, and
/// whether the map's account of the last seconds can be true. It takes nothing from the map.
class OdometryWitness {
 public:
  explicit OdometryWitness(const odometry::Odometry::Setup& setup) : odometry_(setup) {
    set_alone(false);
  }

  void add_imu(const ImuSample& sample) { odometry_.add_imu(sample); }
  void add_scan(const Scan& scan);

  /// Beside a map that tells the pose, a witness is worth less than what edges cost.
  void set_alone(bool alone) { odometry_.use_edges(alone); }

  /// The motion since the last call as a constraint of two nodes; none where the odometry broke, or
  /// was without returns that it could use, in between. Wider than the odometry says, because it
  /// used the readings of the same IMU.
  std::optional<estimator::BetweenFactor> take_motion();

  /// A pose that the map tells now, with the share of the returns that agree with the map there.
  /// The odometry may be wrong as well; the map's pose is held to be wrong where the odometry tells
  /// another way since an earlier pose (up to kStretch ago), or says that the robot was carried,
  /// and the scan agrees less with the map than before. That stays so until the map has explained
  /// the scans of a second as well as ever, and the way too.
  void compare(const MappedPose& now, double inlier_share);

  bool contradicts_map() const { return contradicts_; }

  int epoch() const { return epoch_; }

 private:
  static constexpr TimeNs kStretch = 2 * kSecond;

  /// Motion that was composed of increments.
  struct Way {
    SE3 T_begin_now;
    estimator::Matrix6d covariance = estimator::Matrix6d::Zero();
    double length_m = 0;

    void append(const odometry::Increment& increment);
  };

  double squared_distance(const MappedPose& now) const;
  void judge(bool disagree, double inlier_share);

  odometry::Odometry odometry_;
  TimeNs now_ = 0;
  int epoch_ = 0;
  Way since_node_;
  bool corrected_ = true;  ///< all of it, by scans
  bool whole_ = false;     ///< no break in it
  std::optional<MappedPose> begin_;
  TimeNs begin_time_ = 0;
  Way since_begin_;
  TimeNs break_time_ = 0;
  double usual_share_ = 0;  ///< of inliers, running mean
  TimeNs explained_since_ = 0;
  bool contradicts_ = false;
};

}  // namespace holdfast::pipeline
