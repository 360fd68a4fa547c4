#pragma once

#include <vector>

#include "holdfast/filter/filter_state.hpp"
#include "holdfast/odometry/edges/edge_points.hpp"

namespace holdfast::odometry {

/// Where the planes around tell nothing along some direction (a street, a tunnel), edges do: those
/// of a scan are held against those of an earlier one, the reference, for as long as the two have
/// enough in common, so that errors do not add up from scan to scan.
class EdgeReference {
 public:
  /// Corrects the position in `state`, and by its covariance all else, with the edges of the scan
  /// that `state` is the end of. The first scan, and one that has too little in common with the
  /// reference, becomes the reference.
  void correct(const std::vector<SeenEdge>& edges, const filter::SelectedScan& scan,
               const Eigen::Vector3d& gravity, filter::FilterState& state);

  /// There is none: the next scan begins one.
  void clear() { edges_.clear(); }

 private:
  std::vector<EdgePoint> edges_;  ///< in the odometry's axes, from where the body was
  Eigen::Vector3d p_odom_ = Eigen::Vector3d::Zero();  ///< where it was
};

}  // namespace holdfast::odometry
