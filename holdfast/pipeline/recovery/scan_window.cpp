#include "holdfast/pipeline/recovery/scan_window.hpp"

#include <algorithm>
#include <numbers>
#include <span>

namespace holdfast::pipeline {

bool ScanWindow::newest_is_near() const {
  if (scans_.size() < 2) return false;
  const Seen& last = scans_.back();
  const Seen& before = scans_[scans_.size() - 2];
  const SE3 way = before.T_odom_body.inverse() * last.T_odom_body;
  const double turned = so3::angle_between(before.T_odom_body.rotation, last.T_odom_body.rotation);
  return way.translation.norm() < config_.scan_spacing_m &&
         turned < config_.scan_spacing_deg * std::numbers::pi / 180.0;
}

/// The newest scan stands beside those that are some way apart, and leaves with the next one if it
/// is near the one before it.
void ScanWindow::add(const odometry::Odometry& odometry, int epoch) {
  if (epoch != epoch_) clear();
  epoch_ = epoch;
  if (odometry.points().size() == 0) return;
  if (newest_is_near()) scans_.pop_back();
  scans_.push_back({odometry.state().t, odometry.state().T_map_body, odometry.points()});
  if (scans_.size() > static_cast<std::size_t>(config_.window_scans)) scans_.erase(scans_.begin());
}

relocalization::SearchQuery ScanWindow::query(const odometry::Odometry& odometry,
                                              const Eigen::Vector3d& p_body_lidar,
                                              std::size_t newest_scans) const {
  relocalization::SearchQuery query;
  query.p_body_lidar = p_body_lidar;
  query.gravity_body = (T_odom_newest().rotation.inverse() * odometry.gravity()).normalized();
  const std::size_t first = scans_.size() - std::min(newest_scans, scans_.size());
  for (const Seen& scan : std::span(scans_).subspan(first)) {
    const SE3 T_newest_body = T_odom_newest().inverse() * scan.T_odom_body;
    const Eigen::Matrix3f R = T_newest_body.rotation.toRotationMatrix().cast<float>();
    const Eigen::Vector3f p = T_newest_body.translation.cast<float>();
    const float age_s = static_cast<float>(to_seconds(scan.t - newest()));
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      query.points.points.push_back(R * scan.points.points[i] + p);
      query.points.age_s.push_back(scan.points.age_s[i] + age_s);
    }
  }
  return query;
}

}  // namespace holdfast::pipeline
