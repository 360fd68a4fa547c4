#pragma once

#include <Eigen/Core>
#include <vector>

#include "holdfast/odometry/edges/edge_points.hpp"

namespace holdfast::odometry {

/// What the edges of two scans say about the way between them. Both are given in axes of the same
/// frame, each from where its own scan was taken.
class EdgeWays {
 public:
  EdgeWays(std::vector<EdgePoint> first, std::vector<EdgePoint> second);

  /// The horizontal ways up to `longest_m` on which most upright edges meet one of the first scan,
  /// at most `most`, the most popular first.
  std::vector<Eigen::Vector3d> votes(double longest_m, std::size_t most) const;

  /// Robust sum over the edges of the second scan, moved by a way, of their squared distances from
  /// those of the first, in sigmas. An edge without a partner costs as much as one that is far off.
  /// H and g leave out directions about which all of the edges tell next to nothing.
  struct Fit {
    double cost = 0;
    double weight = 0;  ///< sum of robust weights: how many edges are believed
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();  ///< cost(w + d) ~ cost + 2 g.d + d.H d
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
  };
  Fit fit(const Eigen::Vector3d& way) const;

  /// What edges add to a way that something else has told.
  struct Told {
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();        ///< from that way to the likeliest
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the edges alone
    double weight = 0;                                      ///< how many are believed
  };
  /// `P`: covariance of the error of `way`. Edges of a scan err together, too, by about 1 cm.
  Told refine(const Eigen::Vector3d& way, const Eigen::Matrix3d& P) const;

 private:
  const EdgePoint* partner(const EdgePoint& edge, const Eigen::Vector3f& at) const;

  std::vector<EdgePoint> first_;  ///< in ascending order of x
  std::vector<EdgePoint> second_;
};

}  // namespace holdfast::odometry
