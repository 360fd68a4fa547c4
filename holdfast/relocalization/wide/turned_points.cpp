#include "holdfast/relocalization/wide/turned_points.hpp"

#include <cmath>
#include <numbers>

namespace holdfast::relocalization {
namespace {

/// Cells from the middle of one to where the point is.
int cells(float metres) { return static_cast<int>(std::floor(metres / kCellM + 0.5F)); }

TurnedPoint located(const Eigen::Vector3f& p, const OccupancyPyramid& map, int lane_z) {
  TurnedPoint t;
  t.x = static_cast<std::int16_t>(cells(p.x()));
  t.y = static_cast<std::int16_t>(cells(p.y()));
  t.step = static_cast<std::int32_t>(t.y * map.row_step() + t.x * map.words());
  const int bit = lane_z + cells(p.z()) - map.low_z();  // of the column, that becomes lane 0
  const int word = bit >> 6;
  t.shift = static_cast<std::uint8_t>(bit & 63);
  t.has_low = word >= 0 && word < map.words();
  t.has_high = word + 1 >= 0 && word + 1 < map.words();
  t.low = static_cast<std::int16_t>(t.has_low ? word : 0);
  t.high = static_cast<std::int16_t>(t.has_high ? word + 1 : 0);
  return t;
}

}  // namespace

TurnedPoints::TurnedPoints(const std::vector<Eigen::Vector3f>& points, int yaws,
                           const Eigen::Quaternionf& R_map_level, const OccupancyPyramid& map,
                           const std::vector<int>& lane_z)
    : yaws_(yaws),
      words_(static_cast<int>(lane_z.size())),
      points_((points.size() + 7) / 8 * 8),
      turned_(static_cast<std::size_t>(yaws) * lane_z.size() * points_) {
  for (int k = 0; k < yaws; ++k) {
    const Eigen::AngleAxisf turn(static_cast<float>(yaw(k)), Eigen::Vector3f::UnitZ());
    const Eigen::Matrix3f R = (R_map_level * turn).toRotationMatrix();
    for (int word = 0; word < words_; ++word) {
      TurnedPoint* to = turned_.data() + (static_cast<std::size_t>(k) * words_ + word) * points_;
      for (std::size_t i = 0; i < points.size(); ++i)
        to[i] = located(R * points[i], map, lane_z[word]);
    }
  }
}

double TurnedPoints::yaw(int number) const { return 2 * std::numbers::pi * number / yaws_; }

}  // namespace holdfast::relocalization
