#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "holdfast/core/se3.hpp"
#include "simulation/sensors/lidar/lidar_faults.hpp"

namespace holdfast::simulation {

/// What is wrong with the calibration of a beam: true minus stated angles, measured minus true
/// ranges.
struct BeamError {
  double range_m = 0;
  double elevation_rad = 0;  ///< upwards
  double azimuth_rad = 0;    ///< counter-clockwise seen from above

  bool turns() const { return elevation_rad != 0 || azimuth_rad != 0; }
};

/// One laser of a spinning LiDAR.
struct LidarBeam {
  double elevation_rad = 0;
  TimeNs fire_offset = 0;  ///< from the start of its column; ascending over the list of beams
  std::uint16_t ring = 0;  ///< index from the lowest beam up
  BeamError error = {};    ///< that nobody knows of, see with_beam_errors()
};

/// How a LiDAR looks about that does not spin steadily: its head turns at `turn_hz` (at most once a
/// period) while each line nods about its elevation. No two frames are the same unless both rates
/// times the period are whole numbers.
struct RosettePattern {
  double turn_hz = 9.8732;
  double nod_hz = 302.2977;
  double half_band_rad = 0;  ///< how far a line nods to each side
};

/// A spinning LiDAR. Columns start at equal times over the period; seen from above the head turns
/// clockwise, beginning at the lidar's x axis, and goes on turning between the lasers of a column.
/// With a rosette its lines are the beams and its shots the columns.
struct LidarModel {
  std::vector<LidarBeam> beams;  ///< in firing order
  int columns = 1800;            ///< a revolution
  TimeNs period = kSecond / 10;  ///< of a revolution
  double min_range_m = 0.4;
  double max_range_m = 100.0;
  double range_sigma_m = 0.02;
  bool keep_all_returns = false;  ///< tests: every surface returns every ray
  SE3 T_body_lidar;
  std::optional<RosettePattern> rosette;  ///< none: it spins

  double divergence_rad = 0.003;  ///< of a beam, full angle (VLP-16: 3 mrad, its manual)
  double pulse_length_m = 0.9;    ///< surfaces nearer to each other return as one; 6 ns
  /// Where half of the returns of a square surface of 10 % are seen; by default that of rs16(),
  /// whose manual says 150 m at 20 %: 150 / sqrt(2).
  double reach_at_10_percent_m = 106;
  LidarFaults faults;  ///< off

  /// RoboSense RS-LiDAR-16 at 10 Hz: 16 beams from -15 to +15 degrees, fired 2.8 us apart (lower
  /// half upwards, then upper half downwards), mounted 0.10 m ahead of and 0.15 m above the IMU
  /// with a rotation of about 1.5 degrees.
  static LidarModel rs16();

  /// 128 beams from -22.5 to +22.5 degrees that fire at once, 1024 columns at 10 Hz (as an Ouster
  /// OS1-128); mounted and as noisy as rs16().
  static LidarModel os1_128();
};

}  // namespace holdfast::simulation
