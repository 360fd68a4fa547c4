#include "simulation/sensors/lidar/returns/depth_edges.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace holdfast::simulation {
namespace {

constexpr float kJump = 0.05F;  // metres: half of the smallest step that is found

float inverse(const Echo& echo) { return echo.is_there() ? 1 / echo.range : 0; }

/// True when the inverse range is not `between`, that between its neighbours.
bool jumps(float here, float between, float step_rad) {
  const float larger = std::max(here, between);
  return std::abs(here - between) > (kJump * larger + step_rad) * larger;
}

float step_of(const LidarModel& lidar) {
  const double period_s = to_seconds(lidar.period);
  const double turn = 2 * std::numbers::pi / lidar.columns;
  if (!lidar.rosette) return static_cast<float>(turn);
  const double fastest_nod = 2 * std::numbers::pi * lidar.rosette->nod_hz *
                             lidar.rosette->half_band_rad * period_s / lidar.columns;
  return static_cast<float>(std::hypot(turn, fastest_nod));
}

}  // namespace

DepthEdges::DepthEdges(const LidarModel& lidar) : column_step_rad_(step_of(lidar)) {
  if (lidar.rosette) return;
  const auto elevation = [&](std::size_t i) { return lidar.beams[i].elevation_rad; };
  std::vector<std::size_t> order(lidar.beams.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return elevation(a) < elevation(b); });
  stacks_.resize(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t below = order[k > 0 ? k - 1 : k];
    const std::size_t above = order[std::min(k + 1, order.size() - 1)];
    const double up = elevation(above) - elevation(order[k]);
    const double down = elevation(order[k]) - elevation(below);
    stacks_[order[k]] = {below, above, up + down > 0 ? down / (up + down) : 0.5,
                         static_cast<float>(std::max(up, down))};
  }
}

bool DepthEdges::jumps_along(const Beams& beams, std::size_t column, std::size_t beam) const {
  const std::size_t last = beams.columns() - 1;
  const std::size_t i = column * beams.per_column + beam;
  const Echo* before = column > 0             ? &beams.echoes[i - beams.per_column]
                       : beams.before.empty() ? nullptr
                                              : &beams.before[beam];
  const Echo* after = column < last         ? &beams.echoes[i + beams.per_column]
                      : beams.after.empty() ? nullptr
                                            : &beams.after[beam];
  if (before == nullptr) before = after;
  if (after == nullptr) after = before;
  if (after == nullptr) return false;
  return jumps(inverse(beams.echoes[i]), 0.5F * (inverse(*before) + inverse(*after)),
               column_step_rad_);
}

bool DepthEdges::jumps_across(const Beams& beams, std::size_t column, std::size_t beam) const {
  const Stack& stack = stacks_[beam];
  if (stack.below == beam || stack.above == beam) return false;
  const Echo* row = &beams.echoes[column * beams.per_column];
  const auto share = static_cast<float>(stack.share_above);
  const float between = std::lerp(inverse(row[stack.below]), inverse(row[stack.above]), share);
  return jumps(inverse(row[beam]), between, stack.step_rad);
}

std::vector<std::size_t> DepthEdges::find(const Beams& beams) const {
  std::vector<std::size_t> found;
  for (std::size_t column = 0; column < beams.columns(); ++column) {
    for (std::size_t beam = 0; beam < beams.per_column; ++beam) {
      const bool jumps = jumps_along(beams, column, beam) ||
                         (!stacks_.empty() && jumps_across(beams, column, beam));
      if (jumps) found.push_back(column * beams.per_column + beam);
    }
  }
  return found;
}

}  // namespace holdfast::simulation
