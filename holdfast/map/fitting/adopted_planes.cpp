#include "holdfast/map/fitting/adopted_planes.hpp"

#include <cmath>
#include <cstddef>

namespace holdfast::map {
namespace {

constexpr std::size_t kMostPlanes = 4;  // of a cell
constexpr int kFewPoints = 4;           // as many show that a plane reaches to a cell
constexpr double kReach = 0.2;          // around a cell, as a share of its side
constexpr double kBand = 3.5;           // of the map's noise, around a plane

using Points = std::vector<Eigen::Vector3f>;

/// The points in `cell` or at most kReach beyond its border.
Points points_around(const PointGrid& grid, const Cell& cell) {
  const Eigen::Vector3d middle = (cell.cast<double>().array() + 0.5) * grid.cell_m();
  const double reach = (0.5 + kReach) * grid.cell_m();
  Points around;
  for (int n = 0; n < 27; ++n) {
    for (const auto& p : grid.points(cell + Cell(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1))) {
      if (((p.cast<double>() - middle).array().abs() < reach).all()) around.push_back(p);
    }
  }
  return around;
}

bool is_near(const Surface& plane, const Eigen::Vector3f& p, double band_m) {
  return std::abs(plane.normal.dot(p - plane.center)) < band_m;
}

/// Appends the list of a cell to `out`.
void append_list(const std::vector<Surface>& surfaces, std::uint32_t first,
                 std::vector<Surface>& out) {
  for (std::uint32_t i = first;; ++i) {
    out.push_back(surfaces[i - 1]);
    if (surfaces[i - 1].more == 0) return;
  }
}

/// The neighbour's plane that most of `points` lie on; none where these are too few.
const Surface* best_of_neighbours(SurfaceGrid& grid, const std::vector<Surface>& surfaces,
                                  const Cell& cell, const Points& points, double band_m) {
  const Surface* best = nullptr;
  int most = kFewPoints - 1;
  for (int n = 0; n < 27; ++n) {
    const Cell c = cell + Cell(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    if (n == 13 || !grid.covers(c) || grid.first(c) == 0) continue;
    for (const Surface* s = &surfaces[grid.first(c) - 1];; ++s) {
      int near = 0;
      for (const auto& p : points) near += is_near(*s, p, band_m) ? 1 : 0;
      if (s->kind == SurfaceKind::kPlane && near > most) {
        most = near;
        best = s;
      }
      if (s->more == 0) break;
    }
  }
  return best;
}

}  // namespace

void adopt_planes(const PointGrid& points, const FitOptions& options,
                  const std::vector<Cell>& fitted, SurfaceGrid& grid,
                  std::vector<Surface>& surfaces) {
  const double band = kBand * options.noise_m;
  std::vector<Surface> listed;
  std::vector<std::uint32_t> first_of;
  for (const Cell& cell : fitted) {
    first_of.push_back(0);
    if (grid.first(cell) == 0) continue;
    const std::size_t begin = listed.size();
    first_of.back() = static_cast<std::uint32_t>(begin + 1);
    append_list(surfaces, grid.first(cell), listed);
    if (listed[begin].kind != SurfaceKind::kPlane) continue;
    Points left = points_around(points, cell);
    for (std::size_t i = begin; i < listed.size(); ++i) {
      std::erase_if(left, [&](const auto& p) { return is_near(listed[i], p, band); });
    }
    while (listed.size() - begin < kMostPlanes && left.size() >= kFewPoints) {
      const Surface* plane = best_of_neighbours(grid, surfaces, cell, left, band);
      if (plane == nullptr) break;
      listed.back().more = 1;
      listed.push_back(*plane);
      listed.back().more = 0;
      std::erase_if(left, [&](const auto& p) { return is_near(*plane, p, band); });
    }
  }
  for (std::size_t i = 0; i < fitted.size(); ++i) grid.first(fitted[i]) = first_of[i];
  surfaces = std::move(listed);
}

}  // namespace holdfast::map
