#pragma once

#include <Eigen/Core>

#include "holdfast/core/random.hpp"

namespace holdfast::simulation {

/// Three standard normal values, drawn in the order x, y, z.
inline Eigen::Vector3d normal_vector(RandomStream& random) {
  const double x = random.normal();
  const double y = random.normal();
  return {x, y, random.normal()};
}

}  // namespace holdfast::simulation
