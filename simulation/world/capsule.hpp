#pragma once

#include <Eigen/Core>

namespace holdfast::simulation {

/// A moving solid at one time: all points within `radius` of the segment a-b, moving with
/// `velocity`.
struct Capsule {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
  double radius = 0.1;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
};

/// Where a ray meets a capsule.
struct CapsuleHit {
  double range;
  double cos_incidence;
};

/// First point of the capsule on the ray from `origin` along the unit vector `direction`, between
/// `min_range` and `max_range`; false when there is none. `origin` is outside the capsule.
bool intersect(const Capsule& capsule, const Eigen::Vector3d& origin,
               const Eigen::Vector3d& direction, double min_range, double max_range,
               CapsuleHit& hit);

}  // namespace holdfast::simulation
