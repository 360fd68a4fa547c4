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

  /// A pose that the map tells now. Kept to be compared with later ones.
  void compare(const MappedPose& now);

  /// Squared Mahalanobis distance (6 degrees of freedom) between the way that the map's poses tell
  /// over the last seconds (half to one kStretch) and the odometry's, at the last compare(); none
  /// where the odometry broke since. Both may be off by a little more than their covariances say.
  const std::optional<double>& way_squared_distance() const { return way_squared_distance_; }

  /// What compare() was told is of another place.
  void forget_map();

  /// The odometry begins anew: see there.
  void restart();

  /// Did the odometry say of the newest scan that the robot was carried?
  bool broke() const { return broke_; }

  int epoch() const { return epoch_; }

  /// Did the newest scan tell the odometry how the robot moves?
  bool tells_motion() const { return tells_motion_; }

  const odometry::Odometry& odometry() const { return odometry_; }

 private:
  static constexpr TimeNs kStretch = 4 * kSecond;

  /// Motion that was composed of increments.
  struct Way {
    SE3 T_begin_now;
    estimator::Matrix6d covariance = estimator::Matrix6d::Zero();
    double length_m = 0;

    void append(const odometry::Increment& increment);
  };

  /// From a pose that the map told.
  struct Stretch {
    MappedPose begin;
    TimeNs t = 0;
    Way way;
  };

  double squared_distance(const Stretch& stretch, const MappedPose& now) const;

  odometry::Odometry odometry_;
  TimeNs now_ = 0;
  int epoch_ = 0;
  bool broke_ = false;
  bool tells_motion_ = false;
  Way since_node_;
  bool corrected_ = true;  ///< all of it, by scans
  bool whole_ = false;     ///< no break in it
  std::optional<Stretch> older_;
  std::optional<Stretch> newer_;  ///< half a stretch later; takes the older one's place
  std::optional<double> way_squared_distance_;
};

}  // namespace holdfast::pipeline
