#pragma once

#include <Eigen/Core>

#include "simulation/world/material.hpp"

namespace holdfast::simulation {

/// A solid box of something that moves, along the axes of the body's frame, in metres.
struct BodyBox {
  Eigen::Vector3d center;
  Eigen::Vector3d size;
  Material material;
};

/// Where a ray meets a box.
struct BoxHit {
  double range = 0;                                  ///< metres
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the side that is met, outwards, unit
};

/// First point of the box on the ray from `origin` along the unit vector `direction`, all in the
/// body's frame, between `min_range` and `max_range`; false when there is none, and for a ray that
/// begins within the box.
bool intersect(const BodyBox& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
               double min_range, double max_range, BoxHit& hit);

}  // namespace holdfast::simulation
