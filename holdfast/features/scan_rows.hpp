#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "holdfast/core/sensor_data.hpp"

namespace holdfast::features {

/// The points of a scan sorted into rows of nearly constant elevation, the lowest first, each along
/// its azimuth (in either sense). Positions in the lidar frame. All buffers keep their memory.
struct ScanRows {
  std::vector<Eigen::Vector3f> points;  ///< row by row
  std::vector<std::uint32_t> source;    ///< index of each in the input
  std::vector<std::uint32_t> begin;     ///< of each row in `points`, and the end of the last
  bool regular = true;                  ///< equal steps of azimuth; false: a grid over any pattern

  std::size_t rows() const { return begin.empty() ? 0 : begin.size() - 1; }
  std::size_t size() const { return points.size(); }
};

/// Sorts points into rows, in O(n) and without allocation in a steady state.
class RowSorter {
 public:
  /// By the laser's index where the scan has one, else as the other sort() does.
  void sort(const Scan& scan, ScanRows& out);

  /// Points in the lidar frame, e.g. some of a scan, deskewed. `rings` is as long as `points`, or
  /// empty: then a row is a turn of the azimuth where the log holds ring after ring, else a beam
  /// where the elevations of beams stand apart, else a row of a grid of elevations whose height
  /// follows from the density of the points.
  void sort(const std::vector<Eigen::Vector3f>& points, const std::vector<std::uint16_t>& rings,
            ScanRows& out);

 private:
  bool find_turns(const std::vector<Eigen::Vector3f>& points);
  void count_elevations(const std::vector<Eigen::Vector3f>& points);
  bool find_beams();
  void lay_grid();
  void rows_from_bins();
  void order_by_azimuth(const std::vector<Eigen::Vector3f>& points);
  void distribute(const std::vector<Eigen::Vector3f>& points, ScanRows& out);

  std::vector<Eigen::Vector3f> points_;
  std::vector<std::uint16_t> row_of_;  ///< of each input point
  std::vector<std::uint32_t> order_;   ///< of the input points, before they are split into rows
  std::vector<std::uint16_t> bin_of_;  ///< of elevation, of each input point
  std::vector<std::uint32_t> in_bin_;  ///< number of points in each
  std::vector<std::uint16_t> bin_row_;
  std::vector<std::uint32_t> fill_;
};

}  // namespace holdfast::features
