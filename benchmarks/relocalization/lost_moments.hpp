#pragma once

#include <vector>

#include "holdfast/preprocess/scan_selection.hpp"
#include "holdfast/relocalization/global_search.hpp"
#include "simulation/simulation.hpp"

namespace holdfast::benchmarks {

/// A moment of a drive at which a robot asks where it is, and the truth.
struct LostMoment {
  TimeNs t = 0;
  SE3 T_map_body;
  std::vector<SE3> aliases;           ///< poses from where everything looks the same within noise
  relocalization::SearchQuery scan;   ///< what the last scan shows
  relocalization::SearchQuery scans;  ///< what the last kScansOfAMoment do, by the true motion
};

constexpr int kScansOfAMoment = 6;

/// How a drive is asked.
struct MomentOptions {
  int moments = 10;             ///< at random scans of the drive
  double tilt_sigma_deg = 0.3;  ///< of the direction of gravity, each axis
  bool aliases = true;          ///< look for them: takes some seconds
};

/// Runs the drive to its end. Points are deskewed by the true motion: what an odometry would add is
/// not asked for here.
Result<std::vector<LostMoment>> lost_moments(simulation::Simulation& drive, const SE3& T_body_lidar,
                                             const preprocess::ScanSelectionConfig& selection,
                                             const MomentOptions& options);

}  // namespace holdfast::benchmarks
