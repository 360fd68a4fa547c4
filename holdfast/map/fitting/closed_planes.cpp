#include "holdfast/map/fitting/closed_planes.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

namespace holdfast::map {
namespace {

constexpr double kBand = 3.5;  // of the map's noise, around a plane
constexpr std::uint8_t kAllSectors = 0xff;

/// The eighth of the turn about the plane's centre that a direction along the plane lies in.
std::uint8_t sector_of(float x, float y) {
  const int half = (x < 0 ? 1 : 0) | (y < 0 ? 2 : 0);
  const int side = std::abs(x) < std::abs(y) ? 4 : 0;
  return static_cast<std::uint8_t>(1U << (half | side));
}

bool has_points_all_round(const PointGrid& points, const Cell& cell, const Surface& plane,
                          float band_m) {
  const Eigen::Vector3f u = plane.normal.unitOrthogonal();
  const Eigen::Vector3f v = plane.normal.cross(u);
  const auto reach_sq = static_cast<float>(points.cell_m() * points.cell_m());
  std::uint8_t sectors = 0;
  for (int n = 0; n < 27; ++n) {
    for (const auto& p : points.points(cell + Cell(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1))) {
      const Eigen::Vector3f d = p - plane.center;
      if (d.squaredNorm() > reach_sq || std::abs(plane.normal.dot(d)) > band_m) continue;
      sectors |= sector_of(u.dot(d), v.dot(d));
      if (sectors == kAllSectors) return true;
    }
  }
  return false;
}

}  // namespace

void mark_closed_planes(const PointGrid& points, const FitOptions& options,
                        const std::vector<Cell>& fitted, SurfaceGrid& grid,
                        std::vector<Surface>& surfaces) {
  const auto band_m = static_cast<float>(kBand * options.noise_m);
  for (const Cell& cell : fitted) {
    if (grid.first(cell) == 0) continue;
    for (Surface* s = &surfaces[grid.first(cell) - 1];; ++s) {
      s->closed =
          s->kind == SurfaceKind::kPlane && has_points_all_round(points, cell, *s, band_m) ? 1 : 0;
      if (s->more == 0) break;
    }
  }
}

}  // namespace holdfast::map
