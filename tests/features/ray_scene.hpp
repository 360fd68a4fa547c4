#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "holdfast/core/random.hpp"
#include "holdfast/core/sensor_data.hpp"

/// Scenes of rectangles and upright cylinders whose edges and normals are known, and what a LiDAR
/// of 16 beams at the origin sees of them.
namespace holdfast::features::testing {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kRangeSigma = 0.02;

/// corner + [0, 1] u + [0, 1] v; u and v at right angles.
struct Rectangle {
  Vector3d corner, u, v;

  Vector3d normal() const { return u.cross(v).normalized(); }
  double range(const Vector3d& ray) const {
    const double along = normal().dot(ray);
    if (along == 0) return std::numeric_limits<double>::infinity();
    const double range = normal().dot(corner) / along;
    const Vector3d p = range * ray - corner;
    const double a = p.dot(u) / u.squaredNorm();
    const double b = p.dot(v) / v.squaredNorm();
    const bool inside = range > 0 && a >= 0 && a <= 1 && b >= 0 && b <= 1;
    return inside ? range : std::numeric_limits<double>::infinity();
  }
};

/// Upright, around (x, y), unbounded in height.
struct Cylinder {
  double x, y, radius;

  double range(const Vector3d& ray) const {
    const double a = ray.head<2>().squaredNorm();
    const double b = ray.x() * x + ray.y() * y;
    const double root = b * b - a * (x * x + y * y - radius * radius);
    const double range = root < 0 ? -1 : (b - std::sqrt(root)) / a;
    return range > 0 ? range : std::numeric_limits<double>::infinity();
  }
};

struct Edge {
  Vector3d a, b;

  double distance(const Vector3d& p) const {
    const Vector3d along = b - a;
    const double share = std::min(1.0, std::max(0.0, (p - a).dot(along) / along.squaredNorm()));
    return (a + share * along - p).norm();
  }
};

struct RayScene {
  std::vector<Rectangle> rectangles;
  std::vector<Cylinder> cylinders;
  std::vector<Edge> edges;

  /// The six sides of a box: `low` and `high` are where the LiDAR is not; all edges are true ones.
  void add_box(const Vector3d& low, const Vector3d& high) {
    const Vector3d size = high - low;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d u = size[(axis + 1) % 3] * Vector3d::Unit((axis + 1) % 3);
      const Vector3d v = size[(axis + 2) % 3] * Vector3d::Unit((axis + 2) % 3);
      const Vector3d across = size[axis] * Vector3d::Unit(axis);
      rectangles.push_back({low, u, v});
      rectangles.push_back({low + across, u, v});
      for (const Vector3d& start :
           {low, Vector3d(low + u), Vector3d(low + v), Vector3d(low + u + v)})
        edges.push_back({start, start + across});
    }
  }

  double distance_to_edge(const Vector3d& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Edge& edge : edges) least = std::min(least, edge.distance(p));
    return least;
  }

  /// The rectangle that the ray meets first; -1: a cylinder or nothing.
  int hit(const Vector3d& ray, double& range) const {
    int which = -1;
    range = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < rectangles.size(); ++i) {
      const double r = rectangles[i].range(ray);
      if (r < range) {
        range = r;
        which = static_cast<int>(i);
      }
    }
    for (const Cylinder& cylinder : cylinders) {
      const double r = cylinder.range(ray);
      if (r < range) {
        range = r;
        which = -1;
      }
    }
    return which;
  }

  /// Column after column, clockwise from the x axis, rings from -15 to 15 degrees.
  Scan scan(std::uint64_t seed, double sigma = kRangeSigma, int columns = 1800) const {
    RandomStream random(seed, "ranges");
    Scan scan;
    scan.has_ring = true;
    for (int column = 0; column < columns; ++column) {
      const double azimuth = -2 * M_PI * (column + 0.5) / columns;
      for (int beam = 0; beam < 16; ++beam) {
        const double elevation = (2 * beam - 15) * M_PI / 180;
        const Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                           std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        double range = 0;
        hit(ray, range);
        if (!std::isfinite(range)) continue;
        const Vector3f p = ((range + random.normal(0, sigma)) * ray).cast<float>();
        scan.points.push_back({p.x(), p.y(), p.z(), 0, 0, static_cast<std::uint16_t>(beam)});
      }
    }
    return scan;
  }
};

/// 8 x 6 x 2.8 m, the LiDAR 0.8 m above the floor and off the middle.
inline RayScene room() {
  RayScene scene;
  scene.add_box({-3.1, -2.2, -0.8}, {4.9, 3.8, 2.0});
  return scene;
}

/// The room with a square pillar and a round column.
inline RayScene furnished_room() {
  RayScene scene = room();
  scene.add_box({2.0, 1.0, -0.8}, {2.7, 1.6, 2.0});
  scene.cylinders.push_back({-1.5, 1.5, 0.25});
  return scene;
}

inline Vector3f point_of(const ScanPoint& p) { return {p.x, p.y, p.z}; }

}  // namespace holdfast::features::testing
