#pragma once

#include "baselines/scan_update.hpp"

namespace holdfast::baselines {

/// How far off the given pose may be, and how fast the robot may already be.
struct InitialUncertainty {
  double position_m = 1.0;
  double rotation_rad = 0.1745;
  double speed_m_s = 15.0;
};

struct InitialAlignment {
  FilterState state;       ///< at the end of the scan
  double inlier_share = 0; ///< of the selected points, at the finest resolution
  bool found = false;
};

/// Pose and velocity of the body at the end of a scan, from a pose that may be off by `uncertainty`:
/// starts from a fixed pattern of poses around `prior` (position and yaw), each drawn into the map
/// from the coarsest to the finest resolution with few points, and the best of them refined with all.
/// Same input, same result.
InitialAlignment align_initially(const map::PriorMap& map, const SelectedScan& scan,
                                 const FilterState& prior, const InitialUncertainty& uncertainty,
                                 const Eigen::Vector3d& gravity, const UpdateOptions& options,
                                 WorkerPool& pool, UpdateWorkspace& work);

}  // namespace holdfast::baselines
