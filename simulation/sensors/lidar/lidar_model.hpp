#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/core/se3.hpp"

namespace holdfast::simulation {

/// One laser of a spinning LiDAR.
struct LidarBeam {
  double elevation_rad = 0;
  TimeNs fire_offset = 0;  ///< from the start of its column; ascending over the list of beams
  std::uint16_t ring = 0;  ///< index from the lowest beam up
};

/// A spinning LiDAR. Columns start at equal times over the period; seen from above the head turns
/// clockwise, beginning at the lidar's x axis, and goes on turning between the lasers of a column.
struct LidarModel {
  std::vector<LidarBeam> beams;  ///< in firing order
  int columns = 1800;            ///< a revolution
  TimeNs period = kSecond / 10;  ///< of a revolution
  double min_range_m = 0.4;
  double max_range_m = 100.0;
  double range_sigma_m = 0.02;
  bool keep_all_returns = false;  ///< tests: every surface returns every ray
  SE3 T_body_lidar;

  /// RoboSense RS-LiDAR-16 at 10 Hz: 16 beams from -15 to +15 degrees, fired 2.8 us apart (lower
  /// half upwards, then upper half downwards), mounted 0.10 m ahead of and 0.15 m above the IMU
  /// with a rotation of about 1.5 degrees.
  static LidarModel rs16();

  /// 128 beams from -22.5 to +22.5 degrees that fire at once, 1024 columns at 10 Hz (as an Ouster
  /// OS1-128); mounted and as noisy as rs16().
  static LidarModel os1_128();
};

}  // namespace holdfast::simulation
