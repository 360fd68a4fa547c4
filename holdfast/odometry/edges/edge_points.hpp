#pragma once

#include <Eigen/Core>
#include <vector>

#include "holdfast/features/features.hpp"
#include "holdfast/filter/matching/scan_match.hpp"

namespace holdfast::odometry {

/// A point on a straight edge that several beams have seen, as the sensor saw it.
struct SeenEdge {
  ScanPoint point;                                 ///< lidar frame
  Eigen::Vector3f axis = Eigen::Vector3f::Zero();  ///< unit, either way
  float sigma_m = 0;                               ///< of the position across the edge
};

/// The same where the body's motion puts it.
struct EdgePoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  Eigen::Vector3f direction = Eigen::Vector3f::Zero();
  float sigma_m = 0;
};

/// Finds the edges of a scan, of all its points: at an edge few hit. Edges tell the way along a
/// corridor or a street, where the planes between them tell nothing.
class EdgeFinder {
 public:
  explicit EdgeFinder(double range_sigma_m);

  /// Edges of `scan` at ranges in [min_range_m, max_range_m]. Of a scan with a great many points
  /// only every so many rings are looked at.
  void find(const Scan& scan, double min_range_m, double max_range_m, std::vector<SeenEdge>& out);

 private:
  features::FeatureExtractor extractor_;
  features::Features features_;
  std::vector<Eigen::Vector3f> points_;
  std::vector<std::uint16_t> rings_;
  std::vector<std::uint32_t> source_;  ///< of each of points_ in the scan
};

/// Edges of a scan from where the body was at its end, if it moved as `x` says, in the axes in
/// which `x` is given.
std::vector<EdgePoint> put_edges(const std::vector<SeenEdge>& edges,
                                 const filter::SelectedScan& scan, const filter::MatchState& x);

}  // namespace holdfast::odometry
