#include "simulation/crowd/walkable.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kRoom = 0.3;
constexpr std::array kHeights = {0.35, 1.1, 1.7};  // of knees, trunk and head
/// How far a person reaches to all sides, a step included.
constexpr double kBody = 0.45;
constexpr double kFlat = 0.15;  // what differs by more between knees and head is no wall

Vector3d up(double height) { return {0, 0, height}; }

}  // namespace

std::optional<double> Walkable::range(const Vector3d& from, const Vector3d& direction,
                                      double reach) const {
  RayPacket rays;
  rays.x.fill(static_cast<float>(from.x()));
  rays.y.fill(static_cast<float>(from.y()));
  rays.z.fill(static_cast<float>(from.z()));
  rays.dx.fill(static_cast<float>(direction.x()));
  rays.dy.fill(static_cast<float>(direction.y()));
  rays.dz.fill(static_cast<float>(direction.z()));
  HitPacket hits;
  world_.cast(rays, 0, static_cast<float>(reach), hits);
  if (!std::isfinite(hits.range[0])) return std::nullopt;
  return hits.range[0];
}

std::optional<double> Walkable::ground_under(const Vector3d& p, double reach) const {
  const auto below = range(p, -Vector3d::UnitZ(), reach);
  if (!below) return std::nullopt;
  return p.z() - *below;
}

bool Walkable::is_free(const Vector3d& from, const Vector3d& to) const {
  const Vector3d step = to - from;
  const double length = step.head<2>().norm();
  if (length < 1e-6) return true;
  const Vector3d ahead(step.x() / length, step.y() / length, 0);
  const Vector3d aside(-ahead.y(), ahead.x(), 0);
  const auto is_open = [&](const Vector3d& beyond) {
    return std::all_of(kHeights.begin(), kHeights.end(), [&](double height) {
      return is_visible(from + up(height), to + beyond + up(height));
    });
  };
  return is_open(kRoom * ahead) && is_open(kRoom * aside) && is_open(-kRoom * aside);
}

std::optional<double> Walkable::wall_ahead(const Vector3d& from, const Vector3d& direction,
                                           double reach) const {
  double nearest = reach;
  double furthest = 0;
  for (const double height : kHeights) {
    const auto there = range(from + up(height), direction, reach);
    if (!there) return std::nullopt;
    nearest = std::min(nearest, *there);
    furthest = std::max(furthest, *there);
  }
  if (furthest - nearest > kFlat) return std::nullopt;
  return furthest;
}

bool Walkable::is_hidden(const Vector3d& place, const Vector3d& eye) const {
  const std::array<Vector3d, 5> parts = {Vector3d(0, 0, 0), Vector3d(kBody, 0, 0),
                                         Vector3d(-kBody, 0, 0), Vector3d(0, kBody, 0),
                                         Vector3d(0, -kBody, 0)};
  return std::none_of(parts.begin(), parts.end(), [&](const Vector3d& part) {
    return std::any_of(kHeights.begin(), kHeights.end(),
                       [&](double height) { return is_visible(eye, place + part + up(height)); });
  });
}

}  // namespace holdfast::simulation
