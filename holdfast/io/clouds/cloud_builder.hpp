#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "holdfast/io/point_cloud.hpp"

namespace holdfast::io::clouds {

/// Collects the points of a file: drops and counts what is not finite, and moves the origin when
/// coordinates exceed 10 km.
class CloudBuilder {
 public:
  /// `is_double`: the file holds more digits than a float; `count`: points to expect (a hint).
  CloudBuilder(bool is_double, bool has_intensity, std::size_t count);

  void add(float x, float y, float z, float intensity) {
    if (!(std::isfinite(x) && std::isfinite(y) && std::isfinite(z))) {
      ++cloud_.invalid_points;
      return;
    }
    cloud_.points.emplace_back(x, y, z);
    if (has_intensity_) cloud_.intensity.push_back(intensity);
  }

  void add(double x, double y, double z, float intensity) {
    if (!(std::isfinite(x) && std::isfinite(y) && std::isfinite(z))) {
      ++cloud_.invalid_points;
      return;
    }
    if (is_double_)
      precise_.emplace_back(x, y, z);
    else
      cloud_.points.emplace_back(Eigen::Vector3d(x, y, z).cast<float>());
    if (has_intensity_) cloud_.intensity.push_back(intensity);
  }

  /// The cloud; afterwards the builder is empty.
  PointCloud finish();

 private:
  bool is_double_;
  bool has_intensity_;
  std::vector<Eigen::Vector3d> precise_;
  PointCloud cloud_;
};

}  // namespace holdfast::io::clouds
