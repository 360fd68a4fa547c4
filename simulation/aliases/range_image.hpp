#pragma once

#include <vector>

#include "holdfast/core/se3.hpp"
#include "simulation/world/ray_caster.hpp"

namespace holdfast::simulation {

/// Rays of a range image: rows at some elevations, columns over a whole turn, counter-clockwise
/// from the x axis.
struct ImageRays {
  std::vector<double> elevations;  ///< rad, one a row
  std::size_t columns = 360;       ///< a multiple of 8
  double max_range_m = 100;

  /// `rows` elevations, evenly from `lowest` to `highest`.
  static ImageRays over(double lowest, double highest, std::size_t rows, std::size_t columns,
                        double max_range_m);

  std::size_t size() const { return elevations.size() * columns; }
  /// Unit vector of pixel row * columns + column, in the image's frame.
  const Eigen::Vector3d& direction(std::size_t pixel) const { return directions[pixel]; }

  std::vector<Eigen::Vector3d> directions;
};

/// What stands around a place, without noise.
struct RangeImage {
  std::vector<float> range;            ///< metres; twice the largest range where nothing was met
  std::vector<std::uint32_t> surface;  ///< as HitPacket::triangle
};

/// Casts the image from `T_map_image`.
RangeImage render(const RayCaster& caster, const ImageRays& rays, const SE3& T_map_image);

}  // namespace holdfast::simulation
