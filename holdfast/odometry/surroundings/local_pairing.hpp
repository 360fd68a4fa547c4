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
///
/// What is left speaks about the weak direction with few voices, and one false plane among them
/// (five points of a floor and one of a kerb lean) moves the robot by its own size. Of a few planes
/// only those count that are firm, and their points no more than the plane itself.
///
/// Nothing is paired with a plane that was seen from its other side.
class LocalPairing final : public filter::ScanPairing {
 public:
  /// `settled`: the map was made by known motion. Before, no plane is firm yet.
  LocalPairing(const LocalMap& map, double parallel_sine, bool settled)
      : map_(map), parallel_sine_(parallel_sine), settled_(settled) {}

  Eigen::Vector3d anchor() const override { return map_.anchor(); }
  std::size_t associate(const SE3& T_anchor_body, const Eigen::Vector3d& p_body_lidar,
                        const registration::BodyPoints& points,
                        const registration::AssociationOptions& options, WorkerPool& pool,
                        registration::Correspondences& out) const override;

 private:
  const LocalMap& map_;
  double parallel_sine_;
  bool settled_;
  mutable std::vector<registration::NormalEquations> partials_;
};

}  // namespace holdfast::odometry
