#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "holdfast/core/fields.hpp"
#include "holdfast/core/sensor_data.hpp"

namespace holdfast::preprocess {

/// Both filters are off by default: docs/decisions/0003-ghost-filter.md.
struct GhostFilterConfig {
  bool mixed_pixels = false;
  bool ghosts = false;
  double spot_mrad = 6.0;
  double apart_m = 0.15;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("mixed_pixels", self.mixed_pixels,
          FieldDoc{"drop returns that hang between a nearer and a farther surface"});
    visit("ghosts", self.ghosts,
          FieldDoc{"drop lone returns from behind a surface that is seen on both sides of them"});
    visit("spot_mrad", self.spot_mrad,
          FieldDoc{"rays farther apart than this share no spot of the beam", 0.0, 100.0});
    visit("apart_m", self.apart_m,
          FieldDoc{"ranges that differ by more belong to different surfaces", 0.02, 10.0});
  }
};

/// What a filter took out of a scan.
struct GhostCounts {
  std::size_t mixed_pixels = 0;
  std::size_t ghosts = 0;
};

/// Takes returns out of a scan that lie on no surface (design, section 4: sensor model).
///
/// A *mixed pixel* is the mean of two surfaces that one spot of the beam meets: in range it lies
/// between its two neighbours along the ring, away from both. A *ghost* is the image of something
/// in a polished surface: seen from one scan alone it is a lone return from behind a surface that
/// goes on on both sides. Patches of ghosts look like the view through a window and are left alone,
/// as is all that the rays of the rings above and below see at about the same range: a pole between
/// a wall and a corner is no mixed pixel. Scans without rings are left as they are. O(n); buffers
/// keep their memory.
class GhostFilter {
 public:
  explicit GhostFilter(const GhostFilterConfig& config);

  /// Removes points; order and times of the others stay.
  GhostCounts apply(Scan& scan);

 private:
  enum class Kind : std::uint8_t { kGood, kMixed, kGhost };

  void sort_rows(const Scan& scan);
  void fill_table();
  Kind kind_of(std::size_t at) const;
  bool has_company(std::size_t row, std::size_t at) const;
  bool is_near(std::size_t row, std::size_t at) const;

  GhostFilterConfig config_;
  float spot_cosine_, apart_;
  std::vector<Eigen::Vector3f> rays_;  ///< unit, row by row
  std::vector<float> ranges_;
  std::vector<std::uint32_t> source_, begin_, fill_;
  std::vector<std::uint32_t> table_;  ///< [row][bin of azimuth]: place of a point plus one
  std::vector<Kind> kinds_;           ///< by index in the scan
};

}  // namespace holdfast::preprocess
