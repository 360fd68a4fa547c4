#include "holdfast/pipeline/graph/odometry_witness.hpp"

#include <Eigen/Cholesky>
#include <utility>

namespace holdfast::pipeline {
namespace {

using estimator::Matrix6d;
using estimator::Vector6d;

// Of two witnesses who heard the same third, each counts half.
constexpr double kSharedImu = 2.0;
constexpr double kHuberSigmas = 3.0;

// What the covariances leave out, one sigma: share of the way by which a poor scene misleads the
// odometry, and what the models of map and world are off by.
constexpr double kWayShare = 0.03;
constexpr double kLeastM = 0.05;
constexpr double kLeastRad = 0.01;

/// Of a map pose, with the position in its own body frame.
Matrix6d in_body(const MappedPose& pose) {
  const Eigen::Matrix3d R = pose.T_map_body.rotation.toRotationMatrix();
  Matrix6d J = Matrix6d::Identity();
  J.topLeftCorner<3, 3>() = R.transpose();
  return J * pose.covariance * J.transpose();
}

}  // namespace

void OdometryWitness::Way::append(const odometry::Increment& increment) {
  covariance = odometry::compose_covariance(T_begin_now, covariance, increment);
  T_begin_now = T_begin_now * increment.T_prev_cur;
  length_m += increment.T_prev_cur.translation.norm();
}

void OdometryWitness::add_scan(const Scan& scan) {
  const odometry::OdometryReport report = odometry_.add_scan(scan);
  now_ = scan.end_time;
  epoch_ = report.step.odom_epoch;
  broke_ = report.broke;
  tells_motion_ = report.corrected;
  way_squared_distance_.reset();
  if (!report.increment) {
    whole_ = false;
    older_.reset();
    newer_.reset();
    return;
  }
  corrected_ = corrected_ && report.corrected;
  since_node_.append(*report.increment);
  for (auto* stretch : {&older_, &newer_}) {
    if (*stretch) (*stretch)->way.append(*report.increment);
  }
}

void OdometryWitness::restart() {
  odometry_.begin_anew();
  tells_motion_ = whole_ = false;
  forget_map();
}

void OdometryWitness::forget_map() {
  older_.reset();
  newer_.reset();
  way_squared_distance_.reset();
}

std::optional<estimator::BetweenFactor> OdometryWitness::take_motion() {
  const bool good = whole_ && corrected_;
  const estimator::OdometryIncrement motion{since_node_.T_begin_now,
                                            kSharedImu * since_node_.covariance};
  since_node_ = {};
  whole_ = corrected_ = true;
  if (!good) return std::nullopt;
  return estimator::BetweenFactor(motion, estimator::RobustLoss::kHuber, kHuberSigmas);
}

/// How far the map's account of the way is from the odometry's, in terms of what both may be off.
double OdometryWitness::squared_distance(const Stretch& stretch, const MappedPose& now) const {
  const auto& [begin, t, way] = stretch;
  const SE3 T_begin_now = begin.T_map_body.inverse() * now.T_map_body;
  const SE3 T_odom_map = way.T_begin_now.inverse() * T_begin_now;
  Vector6d d;
  d << T_odom_map.translation, so3::log(T_odom_map.rotation);
  // The begin's error, seen at the end of the way, has a lever.
  Matrix6d lever = Matrix6d::Identity();
  const Eigen::Matrix3d R = way.T_begin_now.rotation.toRotationMatrix();
  lever.topLeftCorner<3, 3>() = R.transpose();
  lever.topRightCorner<3, 3>() = -R.transpose() * so3::hat(way.T_begin_now.translation);
  lever.bottomRightCorner<3, 3>() = R.transpose();
  Matrix6d turned = Matrix6d::Identity();
  turned.topLeftCorner<3, 3>() = R.transpose();
  Matrix6d S = lever * in_body(begin) * lever.transpose() + in_body(now) +
               turned * way.covariance * turned.transpose();
  const double off = kWayShare * way.length_m;
  S.diagonal().head<3>().array() += off * off + kLeastM * kLeastM;
  S.diagonal().tail<3>().array() += kLeastRad * kLeastRad;
  return d.dot(S.ldlt().solve(d));
}

void OdometryWitness::compare(const MappedPose& now) {
  if (older_) way_squared_distance_ = squared_distance(*older_, now);
  if (older_ && now_ >= older_->t + kStretch) older_ = std::exchange(newer_, std::nullopt);
  if (!older_) {
    older_ = Stretch{now, now_, {}};
  } else if (!newer_ && now_ >= older_->t + kStretch / 2) {
    newer_ = Stretch{now, now_, {}};
  }
}

}  // namespace holdfast::pipeline
