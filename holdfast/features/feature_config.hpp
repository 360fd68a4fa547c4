#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "holdfast/core/fields.hpp"

namespace holdfast::features {

/// How points are classified (article 3.2.1), and by which limits.
struct FeatureConfig {
  /// printed: the article's sum over 5 points; log: its logarithm; fitted: windows of a metric
  /// length tested against straight lines. Chosen by the key `features`, which can also be off.
  std::string smoothness = "fitted";
  double edge_sigmas = 1.5;
  double plane_sigmas = 1.0;
  double window_m = 0.3;
  int min_side_points = 4;
  double min_turn_deg = 30.0;
  double plane_spacing_m = 0.1;
  double range_sigma_per_m = 2e-4;
  double beam_spread_rad = 3e-4;
  double roughness_m = 0.003;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("edge_sigmas", self.edge_sigmas,
          FieldDoc{"printed, log: an edge is this many sigmas above the mean", 0.0, 10.0});
    visit("plane_sigmas", self.plane_sigmas,
          FieldDoc{"printed, log: a plane is this many sigmas below the mean", 0.0, 10.0});
    visit("window_m", self.window_m,
          FieldDoc{"fitted: length of the window to each side of a point", 0.05, 5.0});
    visit("min_side_points", self.min_side_points,
          FieldDoc{"fitted: points that a window needs on each side", 2, 50});
    visit("min_turn_deg", self.min_turn_deg,
          FieldDoc{"fitted: least angle between the two sides of an edge", 5.0, 90.0});
    visit("plane_spacing_m", self.plane_spacing_m,
          FieldDoc{"fitted: planar points of a ring are at least this far apart", 0.0, 10.0});
    visit("range_sigma_per_m", self.range_sigma_per_m,
          FieldDoc{"growth of the range's standard deviation with the range", 0.0, 0.1});
    visit("beam_spread_rad", self.beam_spread_rad,
          FieldDoc{"RMS half-angle of the beam: smears a range at grazing incidence", 0.0, 0.05});
    visit("roughness_m", self.roughness_m,
          FieldDoc{"deviation from a straight line that a real flat surface has", 0.0, 0.1});
  }
};

/// Standard deviation of a range by range and incidence (article, section 1: 0.02 m).
struct RangeNoise {
  double sigma_m = 0.02;
  double sigma_per_m = 0;
  double spread_rad = 0;

  /// Variance (m^2) of a point's distance from a surface that it lies on, at a squared range (m^2),
  /// where ray and normal enclose an angle of squared cosine `cosine_sq`: a range error counts by
  /// its part along the normal, and the spot on the surface is smeared along the ray by
  /// range * spread * tan(incidence).
  double normal_variance(double range_sq, double cosine_sq) const {
    const double along_ray = sigma_m * sigma_m + sigma_per_m * sigma_per_m * range_sq;
    return along_ray * cosine_sq + spread_rad * spread_rad * range_sq * (1.0 - cosine_sq);
  }
};

}  // namespace holdfast::features
