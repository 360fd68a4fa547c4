#pragma once

#include <vector>

#include "holdfast/features/features.hpp"
#include "holdfast/features/row_fit.hpp"

namespace holdfast::features {

/// Makes features of what single rows show: a plane is straight across rows too, and an edge goes
/// on from row to row.
class RowLinker {
 public:
  explicit RowLinker(const FeatureConfig& config);

  /// Planes of the points whose windows are straight and that lie on a straight line with the
  /// straight windows of two other rows at the same azimuth, with parallel tangents.
  void find_planes(const ScanRows& rows, const std::vector<WindowFit>& fits,
                   std::vector<Feature>& out);

  /// Directions of edges, from their nearest neighbours in the rows above and below.
  void direct_edges(const ScanRows& rows, const std::vector<RowEdge>& edges,
                    std::vector<Feature>& out);

 private:
  /// A straight window of some row.
  struct Place {
    std::int32_t row = -1;
    std::uint32_t at = 0;
    Eigen::Vector3f position, tangent;
    float sigma_m = 0;
    explicit operator bool() const { return row >= 0; }
  };

  void fill_table();
  Place place(std::int32_t row, std::uint32_t at) const;
  Place find(std::int32_t row, int bin) const;
  Place partner(const Place& from, int bin, std::int32_t direction) const;
  bool plane_through(const Place& from, int bin, Feature& plane) const;
  const RowEdge* nearest(const std::vector<RowEdge>& edges, std::size_t row,
                         const Eigen::Vector3f& to) const;

  float window_m_, spacing_sq_;
  const ScanRows* rows_ = nullptr;
  const std::vector<WindowFit>* fits_ = nullptr;
  std::vector<std::size_t> row_edges_;  ///< where the edges of each row begin
  std::vector<std::uint32_t> table_;    ///< [row][bin of azimuth]: place in ScanRows plus one
};

}  // namespace holdfast::features
