#pragma once

#include <vector>

#include "holdfast/registration/correspondences.hpp"

namespace holdfast::benchmarks {

/// An empty room of 12 x 8 x 3 m with its centre at the origin: the smallest scene in which a
/// registration has one answer.
struct ClosedRoom {
  Eigen::Vector3d half_size{6.0, 4.0, 1.5};

  /// Points of its six sides, `spacing_m` apart, without noise.
  std::vector<Eigen::Vector3f> surface(double spacing_m) const;

  /// What a LiDAR at `T_map_body` sees on the sides: `beams` x `columns` rays in a field of view of
  /// 60 degrees, without noise and motion, in the body frame. Points nearer than `margin_m` to an
  /// edge are left out.
  registration::BodyPoints scan(const SE3& T_map_body, int beams, int columns,
                                double margin_m) const;
};

}  // namespace holdfast::benchmarks
