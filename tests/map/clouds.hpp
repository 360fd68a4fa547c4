#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "holdfast/core/random.hpp"

/// Surfaces with points on them as a surveyor leaves them.
namespace holdfast::map::testing {

using Points = std::vector<Eigen::Vector3f>;

constexpr double kSpacing = 0.06;  // m between neighbouring points
constexpr double kNoise = 0.005;   // m, standard deviation on each axis

inline Eigen::Vector3d noise(RandomStream& random, double sigma) {
  return sigma * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
}

/// Points on the rectangle `corner` + [0, 1] u + [0, 1] v: one in each square of `spacing`,
/// somewhere in it, with `sigma` on each axis.
inline void add_patch(const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
                      const Eigen::Vector3d& v, RandomStream& random, Points& points,
                      double spacing = kSpacing, double sigma = kNoise) {
  const int nu = static_cast<int>(std::round(u.norm() / spacing));
  const int nv = static_cast<int>(std::round(v.norm() / spacing));
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) {
      const Eigen::Vector3d p = corner + (i + random.uniform()) / nu * u +
                                (j + random.uniform()) / nv * v + noise(random, sigma);
      points.push_back(p.cast<float>());
    }
  }
}

/// Points on an upright cylinder.
inline void add_cylinder(const Eigen::Vector3d& base, double radius, double height,
                         RandomStream& random, Points& points) {
  const int around = static_cast<int>(std::round(2 * M_PI * radius / kSpacing));
  const int up = static_cast<int>(std::round(height / kSpacing));
  for (int j = 0; j < up; ++j) {
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * M_PI * (i + random.uniform()) / around;
      const Eigen::Vector3d p(radius * std::cos(angle), radius * std::sin(angle),
                              height * (j + random.uniform()) / up);
      points.push_back((base + p + noise(random, kNoise)).cast<float>());
    }
  }
}

}  // namespace holdfast::map::testing
