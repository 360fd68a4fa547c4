#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace holdfast::map {

/// Cell coordinates; a cell covers [c, c + 1) * cell_m.
using Cell = Eigen::Vector3i;

/// Points sorted into the cells of a dense box of space, for the fits of one tile and level.
class PointGrid {
 public:
  PointGrid(const std::vector<Eigen::Vector3f>& points, double cell_m);

  struct Range {
    const Eigen::Vector3f* first;
    const Eigen::Vector3f* last;
    const Eigen::Vector3f* begin() const { return first; }
    const Eigen::Vector3f* end() const { return last; }
    std::size_t size() const { return static_cast<std::size_t>(last - first); }
  };

  /// Points of a cell; empty outside of the box.
  Range points(const Cell& cell) const {
    const Cell c = cell - low_;
    if ((c.array() < 0).any() || (c.array() >= size_.array()).any()) return {nullptr, nullptr};
    const std::size_t i = index(c);
    return {sorted_.data() + begin_[i], sorted_.data() + begin_[i + 1]};
  }

  double cell_m() const { return cell_m_; }
  Cell cell_of(const Eigen::Vector3f& p) const {
    return (p.cast<double>() / cell_m_).array().floor().cast<int>();
  }
  /// Occupied cells in the order z, y, x.
  const std::vector<Cell>& occupied() const { return occupied_; }

 private:
  std::size_t index(const Cell& c) const {
    return (static_cast<std::size_t>(c.z()) * size_.y() + c.y()) * size_.x() + c.x();
  }

  double cell_m_;
  Cell low_ = Cell::Zero();
  Cell size_ = Cell::Zero();
  std::vector<std::uint32_t> begin_;
  std::vector<Eigen::Vector3f> sorted_;
  std::vector<Cell> occupied_;
};

}  // namespace holdfast::map
