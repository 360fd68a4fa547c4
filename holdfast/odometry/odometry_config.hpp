#pragma once

#include "holdfast/core/fields.hpp"
#include "holdfast/odometry/surroundings/local_map_config.hpp"

namespace holdfast::odometry {

struct OdometryConfig {
  int max_points = 6000;
  int max_inserted = 3000;
  double keyframe_m = 0.3;
  double keyframe_deg = 5.0;
  double surface_sigma_m = 0.005;
  double robust_scale = 3.0;
  double gate_m = 0.3;
  double parallel_sine = 0.3;
  double common_sigma_m = 0.0005;
  double min_inlier_share = 0.1;
  double weak_sigma_m = 0.05;
  double lost_sigma_m = 1.0;
  double inflation = 1.0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_points", self.max_points,
          FieldDoc{"points of a scan that are matched with the local map", 100, 1000000});
    visit("max_inserted", self.max_inserted,
          FieldDoc{"of them that are added to the local map", 100, 1000000});
    visit("keyframe_m", self.keyframe_m,
          FieldDoc{"way after which a scan is added to the local map", 0.01, 10.0});
    visit("keyframe_deg", self.keyframe_deg, FieldDoc{"or turn after which it is", 0.1, 90.0});
    visit("surface_sigma_m", self.surface_sigma_m,
          FieldDoc{"least error of a plane, added to its standard error", 1e-4, 1.0});
    visit("robust_scale", self.robust_scale,
          FieldDoc{"residual, in sigmas, at which a point counts a quarter", 0.5, 100.0});
    visit("gate_m", self.gate_m, FieldDoc{"farther planes are no correspondence", 0.01, 5.0});
    visit("parallel_sine", self.parallel_sine,
          FieldDoc{"a surface whose normal has less than this along a direction that the scene "
                   "hardly determines tells nothing along it",
                   0.0, 1.0});
    visit("common_sigma_m", self.common_sigma_m,
          FieldDoc{"error that all points of a scan have in common", 1e-5, 1.0});
    visit("min_inlier_share", self.min_inlier_share,
          FieldDoc{"a scan that agrees less with the local map is not used", 0.0, 1.0});
    visit("weak_sigma_m", self.weak_sigma_m,
          FieldDoc{"a direction that one scan determines worse than this is weak", 1e-3, 10.0});
    visit("lost_sigma_m", self.lost_sigma_m,
          FieldDoc{"growth of the position's standard deviation without scans beyond which the "
                   "odometry counts as broken",
                   0.05, 100.0});
    visit("inflation", self.inflation,
          FieldDoc{"of the increment's covariance: points of neighbouring scans share the errors "
                   "of the local map",
                   0.1, 1000.0});
  }
};

}  // namespace holdfast::odometry
