#include "simulation/truth/segment_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace holdfast::simulation {

using Eigen::Vector3d;

SegmentGrid::Cell SegmentGrid::cell_of(const Vector3d& p) {
  const auto index = [](double x) { return static_cast<std::int32_t>(std::floor(x / kCell)); };
  return {index(p.x()), index(p.y()), index(p.z())};
}

SegmentGrid::SegmentGrid(const std::vector<Segment>& segments) {
  std::vector<Piece> pieces;
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const auto& [a, b] = segments[i];
    const int count = std::max(1, static_cast<int>(std::ceil((b - a).norm() / kPiece)));
    for (int k = 0; k < count; ++k) {
      const Vector3d from = a + (b - a) * k / count;
      const Vector3d to = a + (b - a) * (k + 1) / count;
      pieces.push_back({{from, to}, static_cast<std::uint32_t>(i)});
      cells.push_back(cell_of(0.5 * (from + to)));
    }
  }
  std::vector<std::size_t> order(pieces.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t k) { return cells[i] < cells[k]; });
  for (const std::size_t i : order) {
    cells_.push_back(cells[i]);
    pieces_.push_back(pieces[i]);
  }
}

std::pair<std::size_t, std::size_t> SegmentGrid::row(const Cell& first) const {
  const Cell last = {first[0], first[1], first[2] + 2};
  const auto begin = std::lower_bound(cells_.begin(), cells_.end(), first);
  const auto end = std::upper_bound(begin, cells_.end(), last);
  return {static_cast<std::size_t>(begin - cells_.begin()),
          static_cast<std::size_t>(end - cells_.begin())};
}

double distance(const Vector3d& p, const Segment& segment) {
  const Vector3d along = segment.b - segment.a;
  const double length_sq = along.squaredNorm();
  const double share = length_sq > 0 ? along.dot(p - segment.a) / length_sq : 0;
  return (segment.a + std::clamp(share, 0.0, 1.0) * along - p).norm();
}

}  // namespace holdfast::simulation
