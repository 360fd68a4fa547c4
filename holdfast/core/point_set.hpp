#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace holdfast {

/// Points as nanoflann asks for them; they stay where they are.
struct PointSet {
  const std::vector<Eigen::Vector3f>& points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

}  // namespace holdfast
