#pragma once

#include <cstddef>
#include <vector>

#include "holdfast/odometry/odometry.hpp"
#include "holdfast/pipeline/recovery/relocalization_config.hpp"
#include "holdfast/relocalization/global_search.hpp"

namespace holdfast::pipeline {

/// The last scans that the odometry links, some way apart: what a search of the map is done with.
/// A break of the odometry empties it, so that no scan is from before the robot was carried (the
/// article's window of the last six holds such scans, 3.4.2).
class ScanWindow {
 public:
  explicit ScanWindow(const RelocalizationConfig& config) : config_(config) {}

  /// The newest scan, as `odometry` holds it, in its epoch.
  void add(const odometry::Odometry& odometry, int epoch);
  void clear() { scans_.clear(); }

  std::size_t size() const { return scans_.size(); }
  /// Of the newest scan; call only if size() > 0.
  TimeNs newest() const { return scans_.back().t; }
  const SE3& T_odom_newest() const { return scans_.back().T_odom_body; }
  int epoch() const { return epoch_; }

  /// The points of the `newest` scans, in the body frame of the newest one.
  relocalization::SearchQuery query(const odometry::Odometry& odometry,
                                    const Eigen::Vector3d& p_body_lidar, std::size_t newest) const;

 private:
  struct Seen {
    TimeNs t = 0;
    SE3 T_odom_body;
    registration::BodyPoints points;
  };

  /// Does the newest scan see much the same as the one before?
  bool newest_is_near() const;

  RelocalizationConfig config_;
  std::vector<Seen> scans_;  ///< the oldest first
  int epoch_ = 0;
};

}  // namespace holdfast::pipeline
