#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "holdfast/relocalization/occupancy/occupancy_pyramid.hpp"

namespace holdfast::relocalization {

/// A point as seen from a LiDAR in the middle of a cell, at one yaw: where its column is, and how
/// that is shifted so that lane k tells whether the point hits something with the LiDAR at height
/// k. Lanes are those of one word of the standpoints.
struct TurnedPoint {
  std::int32_t step = 0;           ///< words from the LiDAR's column to its, at unstrided levels
  std::int16_t x = 0, y = 0;       ///< columns, likewise
  std::int16_t low = 0, high = 0;  ///< words of the column that are shifted into one
  std::uint8_t shift = 0;
  bool has_low = false, has_high = false;
};

/// Points at all yaws.
class TurnedPoints {
 public:
  /// `points` in a level frame from the LiDAR; `R_map_level` turns it so that its z is against the
  /// map's gravity. `lane_z`: lane 0 of each word of the standpoints.
  TurnedPoints(const std::vector<Eigen::Vector3f>& points, int yaws,
               const Eigen::Quaternionf& R_map_level, const OccupancyPyramid& map,
               const std::vector<int>& lane_z);

  int yaws() const { return yaws_; }
  /// Filled up to whole eights with points that hit nothing.
  std::size_t points() const { return points_; }
  double yaw(int number) const;
  const TurnedPoint* at(int yaw, int word) const {
    return turned_.data() + (static_cast<std::size_t>(yaw) * words_ + word) * points_;
  }

 private:
  int yaws_;
  int words_;
  std::size_t points_;
  std::vector<TurnedPoint> turned_;
};

}  // namespace holdfast::relocalization
