#pragma once

#include <Eigen/Core>
#include <vector>

namespace holdfast::relocalization {

struct SpreadOptions {
  int points = 240;
  float flat_share = 0.2F;  ///< of them at most, from floors and ceilings
  float nearest_m = 1.0F;
  float reach_m = 35.0F;  ///< farther points need finer steps of yaw than they are worth
};

/// Points to search with, well spread over all directions: `points` (in a level frame, z up, from
/// the LiDAR) one a cell of 0.5 m; those of upright things before those of floors and ceilings,
/// which tell height and nothing else. They come in turn from all directions, so that the first
/// ones tell about as much as the last ones. Same points, same choice.
std::vector<Eigen::Vector3f> spread_points(const std::vector<Eigen::Vector3f>& points,
                                           const SpreadOptions& options);

}  // namespace holdfast::relocalization
