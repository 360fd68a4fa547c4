#pragma once

#include "holdfast/core/fields.hpp"

namespace holdfast::odometry {

/// See LocalMap.
struct LocalMapConfig {
  double cell_m = 0.25;
  double radius_m = 80.0;
  double noise_slack = 1.2;
  double plane_sigma_m = 0.02;
  double tilt_sigma_rad = 0.05;
  int full_weight = 200;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("cell_m", self.cell_m,
          FieldDoc{"side of the smallest cells of the local map; the others have twice and four "
                   "times that",
                   0.05, 5.0});
    visit("radius_m", self.radius_m, FieldDoc{"cells farther away are forgotten", 10.0, 300.0});
    visit("noise_slack", self.noise_slack,
          FieldDoc{"thickness of a plane, by the noise of a range, above which it is none", 1.0,
                   10.0});
    visit("plane_sigma_m", self.plane_sigma_m,
          FieldDoc{"standard error up to which a plane is worth being matched", 1e-3, 1.0});
    visit("tilt_sigma_rad", self.tilt_sigma_rad, FieldDoc{"and of its normal", 1e-3, 1.0});
    visit("full_weight", self.full_weight,
          FieldDoc{"points after which a cell is left as it is, so that the map does not follow "
                   "the odometry's own errors",
                   10, 100000});
  }
};

}  // namespace holdfast::odometry
