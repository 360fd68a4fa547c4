#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace holdfast::simulation {

/// A straight line between two points.
struct Segment {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
};

/// Segments cut into pieces of at most kPiece and sorted into cells, so that those near a point
/// are found quickly. Thread-safe once made.
class SegmentGrid {
 public:
  static constexpr double kPiece = 0.5;  ///< metres
  static constexpr double kCell = 0.75;  ///< metres
  /// Each segment with a point within this distance of p is among near(p).
  static constexpr double kReach = kCell - 0.5 * kPiece;

  explicit SegmentGrid(const std::vector<Segment>& segments);

  struct Piece {
    Segment segment;
    std::uint32_t of = 0;  ///< index of the segment it was cut from
  };
  /// Calls visit(piece) for the pieces in the cells around `p`, in a fixed order.
  template <class Visit>
  void near(const Eigen::Vector3d& p, const Visit& visit) const {
    const Cell middle = cell_of(p);
    for (std::int32_t x = -1; x <= 1; ++x) {
      for (std::int32_t y = -1; y <= 1; ++y) {
        const auto [begin, end] = row({middle[0] + x, middle[1] + y, middle[2] - 1});
        for (std::size_t i = begin; i < end; ++i) visit(pieces_[i]);
      }
    }
  }

 private:
  using Cell = std::array<std::int32_t, 3>;
  static Cell cell_of(const Eigen::Vector3d& p);
  /// Pieces of three cells, from `first` upwards.
  std::pair<std::size_t, std::size_t> row(const Cell& first) const;

  std::vector<Cell> cells_;    ///< of each piece, ascending
  std::vector<Piece> pieces_;  ///< likewise
};

/// Distance from `p` to the nearest point of a segment.
double distance(const Eigen::Vector3d& p, const Segment& segment);

}  // namespace holdfast::simulation
