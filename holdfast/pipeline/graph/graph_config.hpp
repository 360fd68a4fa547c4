#pragma once

#include <limits>
#include <string>

#include "holdfast/core/fields.hpp"

namespace holdfast::pipeline {

/// What the graph adds to the settings of `map_filter`, with which it shares the matching.
struct GraphConfig {
  double gravity_sigma_m_s2 = 0.05;
  double map_error_share = 0.04;
  double patch_error_share = 1.0;
  double map_correlation_m = 0.5;
  double surprise = 40.0;
  std::string odometry = "on";
  int odometry_points = 2500;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("gravity_sigma_m_s2", self.gravity_sigma_m_s2,
          FieldDoc{"how well the map's gravity is known at the start, each axis", 1e-4, 1.0});
    visit("map_error_share", self.map_error_share,
          FieldDoc{"the map's error over the extent of a scan, as a share of its points' noise",
                   1e-4, 10.0});
    visit("patch_error_share", self.patch_error_share,
          FieldDoc{"how far a surface of the map is off, as a share of its thickness beyond the "
                   "noise of its points",
                   0.0, 10.0});
    visit("map_correlation_m", self.map_correlation_m,
          FieldDoc{"way over which the map's own error stays the same", 1e-3, 100.0});
    visit("surprise", self.surprise,
          FieldDoc{"squared Mahalanobis distance of scan and prediction from which a jump of the "
                   "IMU's biases is considered",
                   1.0, 1e6});
    visit("odometry", self.odometry,
          FieldDoc{"run the odometry beside the graph: it carries the pose on outside of the map, "
                   "and tells when the map cannot be right",
                   -std::numeric_limits<double>::infinity(),
                   std::numeric_limits<double>::infinity(), "on|off"});
    visit("odometry_points", self.odometry_points,
          FieldDoc{"odometry.max_points of the odometry beside the graph", 100, 1000000});
  }
};

}  // namespace holdfast::pipeline
