#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace holdfast::io {

/// A cloud without a sensor: a map, or a set of features. Point i is origin + points[i] in metres.
/// The origin is zero unless a coordinate exceeds 10 km (projected coordinates such as UTM), where
/// float would lose millimetres.
struct PointCloud {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> points;
  std::vector<float> intensity;      ///< empty, or one value a point
  std::uint64_t invalid_points = 0;  ///< NaN or infinite points dropped while reading
};

}  // namespace holdfast::io
