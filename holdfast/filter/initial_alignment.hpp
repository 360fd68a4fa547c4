#pragma once

#include "holdfast/filter/scan_update.hpp"

namespace holdfast::filter {

/// How far off the given pose may be, and how fast the robot may already be.
struct InitialUncertainty {
  double position_m = 1.0;
  double rotation_rad = 0.1745;
  double speed_m_s = 15.0;
};

/// A pose and velocity at the end of a scan that explain it.
struct StartCandidate {
  FilterState state;
  double inlier_share = 0;  ///< of the selected points, at the finest resolution
  bool rests = false;       ///< found on the assumption that the robot is at rest
};

/// Pose and velocity of the body at the end of a scan, from a pose that may be off by
/// `uncertainty`: starts from a fixed pattern of poses around `prior` (position and yaw), each
/// drawn into the map from the coarsest to the finest resolution with few points, and the best of
/// them refined with all. Up to three candidates, of a robot at rest (where the IMU is still), a
/// slow and a fast one, in this order: one scan of a road cannot tell them apart, the next one can.
/// Same input, same result.
std::vector<StartCandidate> align_initially(const map::PriorMap& map, const SelectedScan& scan,
                                            const FilterState& prior,
                                            const InitialUncertainty& uncertainty,
                                            const Eigen::Vector3d& gravity,
                                            const UpdateOptions& options, WorkerPool& pool,
                                            UpdateWorkspace& work);

}  // namespace holdfast::filter
