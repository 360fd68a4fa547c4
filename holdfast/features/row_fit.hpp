#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "holdfast/features/feature_config.hpp"
#include "holdfast/features/scan_rows.hpp"

namespace holdfast::features {

/// What the window around a point of a row says, seen from above (x and y of the lidar frame: what
/// a row adds to that is its constant elevation).
struct WindowFit {
  Eigen::Vector2f tangent = Eigen::Vector2f::Zero();  ///< unit, in the order of the row
  float scale = 1;                                    ///< the point times this lies on the line
  float sigma_m = 0;                                  ///< of that place, across the line
  bool straight = false;
};

/// A place on a row where two straight sides meet, or where a straight face ends in front of
/// something farther.
struct RowEdge {
  std::uint32_t at = 0;  ///< in ScanRows
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  float sigma_m = 0;
};

/// Straight windows and edges of the rows of a scan. O(n): windows move on along a row, and the
/// moments of any window are the difference of two running sums.
class RowFitter {
 public:
  RowFitter(const FeatureConfig& config, const RangeNoise& noise);

  /// `fits` gets one entry a point of `rows`; edges are appended in the order of rows.
  void fit(const ScanRows& rows, std::vector<WindowFit>& fits, std::vector<RowEdge>& edges);

 private:
  struct Sums {
    double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  };
  struct Line;
  enum class Break : std::uint8_t { kNone, kGap, kNearerBefore, kNearerAfter };
  /// Points [begin, end) of a row that nothing interrupts, and what lies beyond.
  struct Segment {
    std::uint32_t begin, end;
    Break before, after;
  };

  void add_up(std::uint32_t begin, std::uint32_t end);
  float typical_step(std::uint32_t begin, std::uint32_t end);
  Break break_after(std::uint32_t i, float step) const;
  void fit_segment(const Segment& segment, std::vector<WindowFit>& fits,
                   std::vector<RowEdge>& edges);
  Line line(std::uint32_t begin, std::uint32_t end) const;
  double variance_at(const Line& line, const Eigen::Vector3f& p) const;
  bool is_straight(const Line& line, double variance) const;
  bool is_clear(std::uint32_t lo, std::uint32_t i, std::uint32_t hi) const;
  void fit_window(std::uint32_t i, const Line& line, double variance, WindowFit& fit) const;
  struct Bend;
  Bend bend(std::uint32_t begin, std::uint32_t end, const Line& line) const;
  double crease(std::uint32_t lo, std::uint32_t i, std::uint32_t hi, RowEdge& edge) const;
  void add_border(const Segment& segment, bool at_end, std::vector<RowEdge>& edges) const;

  double window_sq_, widest_sq_;
  float stride_sq_;
  double clear_sq_, roughness_sq_, least_turn_sine_sq_;
  std::uint32_t least_side_;
  RangeNoise noise_;
  std::array<double, 64> chi_limit_;  ///< by number of points: limit of variance / expected
  const ScanRows* rows_ = nullptr;
  std::vector<Sums> sums_;     ///< sums_[i]: of points [0, i)
  std::vector<float> ranges_;  ///< from the lidar's axis
  std::vector<float> steps_;
};

}  // namespace holdfast::features
