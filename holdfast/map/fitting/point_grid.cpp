#include "holdfast/map/fitting/point_grid.hpp"

#include <limits>

namespace holdfast::map {

PointGrid::PointGrid(const std::vector<Eigen::Vector3f>& points, double cell_m) : cell_m_(cell_m) {
  if (points.empty()) {
    begin_.assign(1, 0);
    return;
  }
  Eigen::Vector3f low = points[0];
  Eigen::Vector3f high = points[0];
  for (const auto& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  low_ = cell_of(low);
  size_ = cell_of(high) - low_ + Cell::Ones();
  begin_.assign(static_cast<std::size_t>(size_.x()) * size_.y() * size_.z() + 1, 0);
  std::vector<std::uint32_t> cell_of_point(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    cell_of_point[i] = static_cast<std::uint32_t>(index(cell_of(points[i]) - low_));
    ++begin_[cell_of_point[i] + 1];
  }
  for (std::size_t i = 1; i < begin_.size(); ++i) {
    if (begin_[i] > 0) {
      const auto c = static_cast<int>(i - 1);
      const int plane = size_.x() * size_.y();
      occupied_.push_back(low_ + Cell(c % size_.x(), c % plane / size_.x(), c / plane));
    }
    begin_[i] += begin_[i - 1];
  }
  sorted_.resize(points.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) sorted_[next[cell_of_point[i]]++] = points[i];
}

}  // namespace holdfast::map
