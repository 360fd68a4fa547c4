#include "holdfast/odometry/surroundings/sight_lines.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::odometry {
namespace {

constexpr float kStepM = 0.4F;
constexpr float kClearM = 0.6F;  // that a ray must go on behind the plane
constexpr float kLongestM = 30.0F;
constexpr float kLeastCosine = 0.3F;  // a ray along a wall does not tell on which side it is

/// True where the ray meets the plane within half a step of `p`.
bool crosses(const LocalMap& map, const Eigen::Vector3f& p, const Eigen::Vector3f& direction) {
  const LocalMap::Hit hit = map.find(0, p);
  if (hit.surface == nullptr) return false;
  const float cosine = std::abs(hit.surface->normal.dot(direction));
  const float distance = std::abs(hit.surface->normal.dot(p - hit.corner - hit.surface->center));
  return cosine > kLeastCosine && distance < 0.5F * kStepM * cosine;
}

bool seen_through(const LocalMap& map, const Eigen::Vector3f& lidar, const Eigen::Vector3f& p) {
  const Eigen::Vector3f ray = p - lidar;
  const float range = ray.norm();
  const Eigen::Vector3f direction = ray / range;
  const float last = std::min(range - kClearM, kLongestM);
  for (float s = kStepM; s < last; s += kStepM) {
    if (crosses(map, lidar + s * direction, direction)) return true;
  }
  return false;
}

}  // namespace

double share_seen_through(const LocalMap& map, const registration::BodyPoints& points,
                          const registration::Correspondences& pairs, const SE3& T_odom_body,
                          const Eigen::Vector3d& p_body_lidar, std::size_t most) {
  const Eigen::Matrix3f R = T_odom_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f t = (T_odom_body.translation - map.anchor()).cast<float>();
  const Eigen::Vector3f lidar = R * p_body_lidar.cast<float>() + t;
  const std::size_t stride = std::max<std::size_t>(points.size() / most, 1);
  std::size_t looked = 0, through = 0;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    ++looked;
    if (pairs.information[i] > 0) continue;
    through += seen_through(map, lidar, R * points.points[i] + t) ? 1 : 0;
  }
  return looked == 0 ? 0.0 : static_cast<double>(through) / static_cast<double>(looked);
}

}  // namespace holdfast::odometry
