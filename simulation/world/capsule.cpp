#include "simulation/world/capsule.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

/// Smaller root of a x^2 + 2 half_b x + c = 0; false without one.
bool first_root(double a, double half_b, double c, double& root) {
  const double discriminant = half_b * half_b - a * c;
  if (discriminant < 0) return false;
  root = (-half_b - std::sqrt(discriminant)) / a;
  return true;
}

}  // namespace

bool intersect(const Capsule& capsule, const Vector3d& origin, const Vector3d& direction,
               double min_range, double max_range, CapsuleHit& hit) {
  const Vector3d axis = capsule.b - capsule.a;
  const Vector3d from = origin - capsule.a;
  const double axis_sq = axis.squaredNorm();
  const double axis_dir = axis.dot(direction);
  const double axis_from = axis.dot(from);
  const double dir_from = direction.dot(from);
  const double radius_sq = capsule.radius * capsule.radius;

  // The mantle: distance to the axis equals the radius, between the ends.
  const double a = axis_sq - axis_dir * axis_dir;
  const double half_b = axis_sq * dir_from - axis_from * axis_dir;
  const double c = axis_sq * from.squaredNorm() - axis_from * axis_from - radius_sq * axis_sq;
  double range = 0;
  double along = axis_dir > 0 ? -1 : 2 * axis_sq;  // on the axis: 0 at a, axis_sq at b
  if (a > 1e-12 * axis_sq) {                       // else along the axis, into one of its ends
    if (!first_root(a, half_b, c, range)) return false;
    along = axis_from + range * axis_dir;
  }
  if (along <= 0 || along >= axis_sq) {  // else the nearer of the two end balls
    const bool end_b = along >= axis_sq && axis_sq > 0;
    const Vector3d from_end = end_b ? Vector3d(origin - capsule.b) : from;
    const double ball_c = from_end.squaredNorm() - radius_sq;
    if (!first_root(1, direction.dot(from_end), ball_c, range)) return false;
    along = end_b ? axis_sq : 0;
  }
  if (!(range >= min_range && range <= max_range)) return false;
  const Vector3d center = capsule.a + axis * (axis_sq > 0 ? along / axis_sq : 0);
  const Vector3d normal = (origin + range * direction - center) / capsule.radius;
  hit = {range, std::min(1.0, std::abs(normal.dot(direction)))};
  return true;
}

}  // namespace holdfast::simulation
