#pragma once

#include "holdfast/filter/scan_update.hpp"
#include "holdfast/odometry/surroundings/local_map.hpp"

namespace holdfast::odometry {

/// Pairs a scan with the local map and takes out what the errors of its normals feign.
///
/// A plane fitted to some tens of points is tilted by some hundredths of a radian. Along a
/// direction that the scene hardly determines (a corridor's axis), thousands of tilted walls seem
/// to know where one is, and since they fit best where they were seen, they hold the robot back. So
/// a surface tells nothing along a weak direction that it is parallel to within `parallel_sine`:
/// the weak direction is taken out of its normal, its distance stays.
class LocalPairing final : public filter::ScanPairing {
 public:
  LocalPairing(const LocalMap& map, double parallel_sine)
      : map_(map), parallel_sine_(parallel_sine) {}

  Eigen::Vector3d anchor() const override { return map_.anchor(); }
  std::size_t associate(const SE3& T_anchor_body, const Eigen::Vector3d& p_body_lidar,
                        const registration::BodyPoints& points,
                        const registration::AssociationOptions& options, WorkerPool& pool,
                        registration::Correspondences& out) const override;

 private:
  const LocalMap& map_;
  double parallel_sine_;
  mutable std::vector<registration::NormalEquations> partials_;
};

}  // namespace holdfast::odometry
