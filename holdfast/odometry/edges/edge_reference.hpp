#pragma once

#include <vector>

#include "holdfast/filter/filter_state.hpp"
#include "holdfast/odometry/bias_jump.hpp"
#include "holdfast/odometry/edges/edge_points.hpp"

namespace holdfast::odometry {

/// Where the planes around tell nothing along some direction (a street, a tunnel), edges do: those
/// of a scan are held against those of an earlier one, the reference, for as long as the two have
/// enough in common, so that errors do not add up from scan to scan.
///
/// What the edges measure is the way since the reference. Its error r is kept beside the state's
/// errors e, with their covariance (a stochastic clone of the reference's position, Roumeliotis and
/// Burdick 2002): what many scans have in common in r, the errors of the reference's own edges
/// above all, is then never taken for knowledge.
class EdgeReference {
 public:
  /// The state has gone on and was corrected by all but edges. `P_before`, `P_now`: covariances of
  /// its errors before and now; `now_before`: of the errors now (rows) with those before.
  void follow(const filter::Matrix15d& P_before, const filter::Matrix15d& P_now,
              const filter::Matrix15d& now_before);

  /// Corrects `state` with the edges of the scan that it is the end of, and `now_before` with it.
  /// The first scan, and one that has too little in common with the reference, becomes the
  /// reference.
  void correct(const std::vector<SeenEdge>& edges, const filter::SelectedScan& scan,
               const Eigen::Vector3d& gravity, filter::FilterState& state,
               filter::Matrix15d& now_before);

  /// The errors of the state were replaced by `change` times themselves.
  void change_errors(const filter::Matrix15d& change) { cross_ = (change * cross_).eval(); }

  /// The state's biases jumped, and it was put right; since when the reference stands is taken for
  /// longer ago.
  void allow_for(const BiasJump& jump);

  /// There is none: the next scan begins one.
  void clear() { edges_.clear(); }

 private:
  void begin(std::vector<EdgePoint> edges, const Eigen::Vector3d& p_odom);

  std::vector<EdgePoint> edges_;  ///< in the odometry's axes, from where the body was
  Eigen::Vector3d p_odom_ = Eigen::Vector3d::Zero();  ///< where that was, as far as now known
  Eigen::Matrix3d P_way_ = Eigen::Matrix3d::Zero();   ///< of r
  /// Of e (rows) and r.
  Eigen::Matrix<double, 15, 3> cross_ = Eigen::Matrix<double, 15, 3>::Zero();
  /// Of r and the errors of the state before.
  Eigen::Matrix<double, 3, 15> with_before_ = Eigen::Matrix<double, 3, 15>::Zero();
};

}  // namespace holdfast::odometry
