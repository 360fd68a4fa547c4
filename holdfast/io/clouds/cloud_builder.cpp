#include "holdfast/io/clouds/cloud_builder.hpp"

#include <algorithm>
#include <utility>

namespace holdfast::io::clouds {
namespace {

constexpr double kFarthestM = 10e3;

template <class Point>
bool exceeds_range(const std::vector<Point>& points) {
  return std::any_of(points.begin(), points.end(), [](const Point& p) {
    return p.template lpNorm<Eigen::Infinity>() > static_cast<typename Point::Scalar>(kFarthestM);
  });
}

/// Median of each coordinate in whole metres: unlike a mean or the middle of the bounds, a stray
/// point does not move it.
template <class Point>
Eigen::Vector3d choose_origin(const std::vector<Point>& points) {
  Eigen::Vector3d origin;
  std::vector<typename Point::Scalar> values(points.size());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < points.size(); ++i) values[i] = points[i][axis];
    std::nth_element(values.begin(), middle, values.end());
    origin[axis] = std::round(static_cast<double>(*middle));
  }
  return origin;
}

/// Points relative to `origin` as floats; those that a float cannot hold are dropped and counted.
template <class Point>
void move_points(const std::vector<Point>& from, const Eigen::Vector3d& origin, PointCloud& cloud) {
  std::vector<Eigen::Vector3f> to;
  to.reserve(from.size());
  std::vector<float> intensity;
  intensity.reserve(cloud.intensity.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector3f p = (from[i].template cast<double>() - origin).template cast<float>();
    if (!p.allFinite()) {
      ++cloud.invalid_points;
      continue;
    }
    to.push_back(p);
    if (!cloud.intensity.empty()) intensity.push_back(cloud.intensity[i]);
  }
  cloud.origin = origin;
  cloud.points = std::move(to);
  cloud.intensity = std::move(intensity);
}

}  // namespace

CloudBuilder::CloudBuilder(bool is_double, bool has_intensity, std::size_t count)
    : is_double_(is_double), has_intensity_(has_intensity) {
  if (is_double)
    precise_.reserve(count);
  else
    cloud_.points.reserve(count);
  if (has_intensity) cloud_.intensity.reserve(count);
}

PointCloud CloudBuilder::finish() {
  if (is_double_) {
    const bool far = exceeds_range(precise_);
    move_points(precise_, far ? choose_origin(precise_) : Eigen::Vector3d::Zero(), cloud_);
  } else if (exceeds_range(cloud_.points)) {
    const auto points = std::move(cloud_.points);
    move_points(points, choose_origin(points), cloud_);
  }
  precise_ = {};
  return std::exchange(cloud_, PointCloud{});
}

}  // namespace holdfast::io::clouds
