#include "benchmarks/drives/closed_room.hpp"

#include <cmath>
#include <numbers>

namespace holdfast::benchmarks {
namespace {

/// Direction of a ray in the body frame.
Eigen::Vector3d direction(double elevation, double azimuth) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

/// Distance from `p` inside the room to its surface along `d`.
double distance(const Eigen::Vector3d& half_size, const Eigen::Vector3d& p,
                const Eigen::Vector3d& d) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0) continue;
    nearest = std::min(nearest, (std::copysign(half_size[axis], d[axis]) - p[axis]) / d[axis]);
  }
  return nearest;
}

bool near_edge(const Eigen::Vector3d& half_size, const Eigen::Vector3d& p, double margin) {
  return ((half_size - p.cwiseAbs()).array() < margin).count() > 1;
}

}  // namespace

std::vector<Eigen::Vector3f> ClosedRoom::surface(double spacing_m) const {
  std::vector<Eigen::Vector3f> points;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (double a = -half_size[u]; a <= half_size[u]; a += spacing_m) {
      for (double b = -half_size[v]; b <= half_size[v]; b += spacing_m) {
        Eigen::Vector3d p;
        p[axis] = half_size[axis];
        p[u] = a;
        p[v] = b;
        points.push_back(p.cast<float>());
        points.push_back((-p).cast<float>());
      }
    }
  }
  return points;
}

registration::BodyPoints ClosedRoom::scan(const SE3& T_map_body, int beams, int columns,
                                          double margin_m) const {
  registration::BodyPoints points;
  for (int column = 0; column < columns; ++column) {
    for (int beam = 0; beam < beams; ++beam) {
      const Eigen::Vector3d ray = direction(std::numbers::pi / 3 * ((beam + 0.5) / beams - 0.5),
                                            2 * std::numbers::pi * column / columns);
      const Eigen::Vector3d d = T_map_body.rotation * ray;
      const double range = distance(half_size, T_map_body.translation, d);
      if (near_edge(half_size, T_map_body.translation + range * d, margin_m)) continue;
      points.points.push_back((range * ray).cast<float>());
      points.age_s.push_back(0);
    }
  }
  return points;
}

}  // namespace holdfast::benchmarks
