#include "simulation/movers/body_box.hpp"

#include <cmath>
#include <limits>

namespace holdfast::simulation {

using Eigen::Vector3d;

bool intersect(const BodyBox& box, const Vector3d& origin, const Vector3d& direction,
               double min_range, double max_range, BoxHit& hit) {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  int side = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double from = origin[axis] - box.center[axis];
    const double half = 0.5 * box.size[axis];
    if (direction[axis] == 0) {
      if (std::abs(from) > half) return false;
      continue;
    }
    const double reach = half / std::abs(direction[axis]);
    const double middle = -from / direction[axis];
    if (middle - reach > enter) {
      enter = middle - reach;
      side = axis;
    }
    leave = std::min(leave, middle + reach);
  }
  if (enter > leave || !(enter >= min_range && enter <= max_range)) return false;
  hit.range = enter;
  hit.normal = Vector3d::Zero();
  hit.normal[side] = direction[side] > 0 ? -1 : 1;
  return true;
}

}  // namespace holdfast::simulation
