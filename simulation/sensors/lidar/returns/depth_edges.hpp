#pragma once

#include <vector>

#include "simulation/sensors/lidar/lidar_model.hpp"
#include "simulation/sensors/lidar/returns/beams.hpp"

namespace holdfast::simulation {

/// Finds the beams next to which the depth jumps. Along a line of equal angles the inverse range of
/// a plane is all but linear; a beam whose inverse range is not that between its neighbours', by
/// more than 5 cm and what a right-angled corner makes, stands at an edge. Neighbours are the
/// columns before and after, and the beams above and below (not of a rosette, whose lines lie far
/// apart). Steps of less than 0.1 m are not found.
class DepthEdges {
 public:
  explicit DepthEdges(const LidarModel& lidar);

  float column_step_rad() const { return column_step_rad_; }
  /// Indices into beams.echoes, ascending.
  std::vector<std::size_t> find(const Beams& beams) const;

 private:
  struct Stack {
    std::size_t below, above;  ///< index of the beam; itself: there is none
    double share_above;        ///< weight of the one above in the interpolation
    float step_rad;            ///< to the farther of the two
  };
  bool jumps_along(const Beams& beams, std::size_t column, std::size_t beam) const;
  bool jumps_across(const Beams& beams, std::size_t column, std::size_t beam) const;

  float column_step_rad_;
  std::vector<Stack> stacks_;  ///< of each beam; empty for a rosette
};

}  // namespace holdfast::simulation
