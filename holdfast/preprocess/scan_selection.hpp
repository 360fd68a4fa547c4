#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/core/fields.hpp"
#include "holdfast/core/sensor_data.hpp"

namespace holdfast::preprocess {

struct ScanSelectionConfig {
  double min_range_m = 0.7;
  double max_range_m = 150.0;
  int max_points = 8000;
  double least_share = 0.25;
  int most_points = 32000;
  double poor_sigma_m = 0.01;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_range_m", self.min_range_m,
          FieldDoc{"nearer returns are dropped (the robot itself)", 0.0, 100.0});
    visit("max_range_m", self.max_range_m, FieldDoc{"farther returns are dropped", 1.0, 1000.0});
    visit("max_points", self.max_points,
          FieldDoc{"points of a scan that are matched with the map, spread over the whole scan",
                   100, 1000000});
    visit("least_share", self.least_share,
          FieldDoc{"share of a scan's points that are matched though they be more than max_points: "
                   "a sensor of many beams costs more and tells more",
                   0.0, 1.0});
    visit("most_points", self.most_points,
          FieldDoc{"likewise, in place of max_points, while that many leave a direction poorly "
                   "known",
                   100, 1000000});
    visit("poor_sigma_m", self.poor_sigma_m,
          FieldDoc{"a direction that one scan determines worse than this is poorly known", 1e-4,
                   10.0});
  }
};

/// Chooses the points of a scan to work with: indices in ascending order into `scan.points`. Where
/// there are more than `max_points` and the least share allow, one of each run of neighbours is
/// taken at a place drawn anew for each run and `scan_number` (same number, same choice), so that
/// no beam of a regular pattern is favoured. Returns the number of points inside the limits of
/// range. `out` keeps its memory.
std::size_t select_points(const Scan& scan, const ScanSelectionConfig& config,
                          std::uint64_t scan_number, std::vector<std::uint32_t>& out);

}  // namespace holdfast::preprocess
