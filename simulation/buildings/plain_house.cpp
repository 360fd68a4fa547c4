#include "simulation/buildings/plain_house.hpp"

#include <array>

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kStorey = 3.2;

/// A row of windows from `begin` to `end` along a facade, `up` metres above those of the ground
/// floor.
std::vector<WallOpening> windows(double begin, double end, double step, double up) {
  std::vector<WallOpening> out;
  for (double at = begin; at + 1.4 <= end; at += step) {
    WallOpening window{at, 1.4, 0.9, 2.4, 0.22, false, materials::kGlass};
    window.bottom += up;
    window.top += up;
    out.push_back(window);
  }
  return out;
}

}  // namespace

void PlainHouse::add_to(WorldBuilder& build) const {
  const std::array<Vector2d, 4> corners = {{min, {min.x(), max.y()}, max, {max.x(), min.y()}}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d& from = corners[i];
    const Vector2d& to = corners[(i + 1) % corners.size()];
    const double end = (to - from).norm() - 1;
    const double side = static_cast<double>(i);
    const double begin = 1.2 + 0.3 * side;
    const double step = window_step + 0.17 * side;
    build.wall({from, to, 0, kStorey, materials::kBrick, windows(begin, end, step, 0)});
    build.wall({from, to, kStorey, height, materials::kBrick, windows(begin, end, step, kStorey)});
  }
  build.floor(min, max, height, materials::kConcrete);
}

}  // namespace holdfast::simulation
