#include "simulation/wayfinding/surface_samples.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kMostCells = 2e7;
constexpr double kFacesUp = 0.3;  // vertical part of the normal

/// Heights of surfaces over cells.
class Samples {
 public:
  explicit Samples(const Grid& grid) : grid_(grid) {}

  void add(const Vector3d& p, bool faces_up = false) {
    const std::size_t cell = grid_.at(p.head<2>());
    if (cell == grid_.size()) return;
    all_.push_back({static_cast<std::uint32_t>(cell), static_cast<float>(p.z()), faces_up});
  }

  /// Points of a triangle not more than half a cell apart.
  void add_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double step = 0.5 * grid_.cell_m;
    const bool faces_up = (b - a).cross(c - a).normalized().z() > kFacesUp;
    const int rows = 1 + static_cast<int>(std::max((b - a).norm(), (c - a).norm()) / step);
    for (int i = 0; i <= rows; ++i) {
      const double u = static_cast<double>(i) / rows;
      const Vector3d from = a + u * (b - a);
      const Vector3d to = a + u * (c - a);
      const int columns = 1 + static_cast<int>((to - from).norm() / step);
      for (int k = 0; k <= columns; ++k) add(from + (to - from) * k / columns, faces_up);
    }
  }

  std::vector<SurfaceSample> sorted() {
    std::stable_sort(all_.begin(), all_.end());
    return std::move(all_);
  }

 private:
  const Grid& grid_;
  std::vector<SurfaceSample> all_;
};

}  // namespace

Grid grid_over(const World& world, double cell_m) {
  Eigen::AlignedBox3f box;
  for (const auto& triangle : world.triangles) {
    for (const std::uint32_t k : triangle) box.extend(world.vertices[k]);
  }
  for (const Disc& disc : world.discs) box.extend(disc.center);
  Grid grid;
  if (box.isEmpty()) return grid;
  const Vector3d size = box.sizes().cast<double>();
  grid.cell_m = std::max(cell_m, std::sqrt(size.x() * size.y() / kMostCells));
  grid.low = box.min().cast<double>().head<2>();
  grid.width = static_cast<std::int32_t>(size.x() / grid.cell_m) + 1;
  grid.height = static_cast<std::int32_t>(size.y() / grid.cell_m) + 1;
  return grid;
}

std::vector<SurfaceSample> samples_of(const World& world, const Grid& grid) {
  Samples samples(grid);
  for (const auto& triangle : world.triangles) {
    const auto corner = [&](int k) -> Vector3d {
      return world.vertices[triangle[k]].cast<double>();
    };
    samples.add_triangle(corner(0), corner(1), corner(2));
  }
  for (const Disc& disc : world.discs) samples.add(disc.center.cast<double>());
  return samples.sorted();
}

std::vector<std::size_t> connected_cells(const Grid& grid, std::size_t seed,
                                         std::vector<bool>& allowed) {
  std::vector<std::size_t> found = {seed};
  allowed[seed] = false;
  for (std::size_t next = 0; next < found.size(); ++next) {
    grid.around(found[next], [&](std::size_t k, double) {
      if (!allowed[k]) return;
      allowed[k] = false;
      found.push_back(k);
    });
  }
  return found;
}

}  // namespace holdfast::simulation
