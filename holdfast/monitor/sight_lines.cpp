#include "holdfast/monitor/sight_lines.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::monitor {
namespace {

using Eigen::Vector3f;

// Shares of the side of a cell of the finest level.
constexpr float kStep = 0.7F;   // short enough to meet each plane that is crossed near its centre
constexpr float kReach = 0.7F;  // from the centre of a plane, where it is closed
// Where the next but one coarser level has nothing within a cell of its, 2 cells are a safe step.
constexpr int kWideLevel = 2;
constexpr float kWideStep = 2.0F;
constexpr float kCellM = 0.5F;  // about; only the steps depend on it

/// A line as start, direction and length.
struct Ray {
  Vector3f from;
  Vector3f direction;
  float length;
};

bool crosses(const Ray& ray, const map::Surface& plane, const Vector3f& corner, float begin,
             float end, const SightOptions& options) {
  if (plane.closed == 0 || plane.sigma_m > options.thickest_m) return false;
  const float along = plane.normal.dot(ray.direction);
  if (std::abs(along) < options.least_cosine) return false;
  const Vector3f center = plane.center + corner;
  const float t = plane.normal.dot(center - ray.from) / along;
  if (t < begin || t > end) return false;
  const float reach = kReach * kCellM;
  return (ray.from + t * ray.direction - center).squaredNorm() < reach * reach;
}

/// Does the ray cross a closed plane between `begin` and `end` metres from its start?
bool meets_wall(const map::PriorMap& map, const Ray& ray, float begin, float end,
                const SightOptions& options) {
  const map::Surface* last = nullptr;
  for (float t = begin; t < end; t += kStep * kCellM) {
    const Vector3f p = ray.from + t * ray.direction;
    const auto hit = map.find(0, p);
    if (hit.surface == nullptr) {
      if (map.find(kWideLevel, p).surface == nullptr) t += (kWideStep - kStep) * kCellM;
      continue;
    }
    if (hit.surface == last) continue;
    last = hit.surface;
    for (const map::Surface* s = hit.surface;; ++s) {
      if (crosses(ray, *s, hit.corner, begin, end, options)) return true;
      if (s->more == 0) break;
    }
  }
  return false;
}

void count(const map::PriorMap& map, const Ray& ray, const SightOptions& options,
           SightCounts& counts) {
  ++counts.lines;
  const float margin = std::max(options.margin_m, options.margin_share * ray.length);
  if (meets_wall(map, ray, 0.5F * options.least_m, ray.length - margin, options)) {
    ++counts.through;
  } else if (map.find(1, ray.from + ray.length * ray.direction).surface != nullptr) {
    ++counts.mapped;
  } else if (meets_wall(map, ray, ray.length + margin, ray.length + options.beyond_m, options)) {
    ++counts.in_front;
  } else {
    ++counts.unmapped;
  }
}

}  // namespace

SightCounts follow(const map::PriorMap& map, std::span<const SightLine> lines,
                   const SightOptions& options) {
  SightCounts counts;
  for (const SightLine& line : lines) {
    const Vector3f way = line.to - line.from;
    const float length = way.norm();
    if (length < options.least_m) continue;
    count(map, {line.from, way / length, length}, options, counts);
  }
  return counts;
}

}  // namespace holdfast::monitor
