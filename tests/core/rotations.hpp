#pragma once

#include <numbers>
#include <vector>

#include "holdfast/core/random.hpp"
#include "holdfast/core/so3.hpp"

namespace holdfast::testing {

inline Eigen::Vector3d random_direction(RandomStream& random) {
  return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

/// Rotation vectors at the identity, near it (on both sides of where Taylor series take over), of
/// random size, and near pi.
inline std::vector<Eigen::Vector3d> rotation_vectors() {
  std::vector<Eigen::Vector3d> out = {Eigen::Vector3d::Zero()};
  RandomStream random(1, "rotation vectors");
  const double pi = std::numbers::pi;
  for (const double angle : {1e-12, 1e-9, 1e-6, 0.99e-4, 1.01e-4, 1.99e-4, 2.01e-4, 1e-3, 0.1, 1.0,
                             2.0, 3.0, pi - 1e-3, pi - 1e-6}) {
    for (int i = 0; i < 8; ++i) out.push_back(angle * random_direction(random));
    out.push_back(angle * Eigen::Vector3d::UnitX());
    out.push_back(-angle * Eigen::Vector3d::UnitZ());
  }
  for (int i = 0; i < 50; ++i) out.push_back(random.uniform(0, pi) * random_direction(random));
  return out;
}

}  // namespace holdfast::testing
