#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "holdfast/preprocess/deskew.hpp"
#include "simulation/simulation.hpp"

namespace holdfast::benchmarks {

/// Ways to put the points of a scan where they belong at the time of its last point.
enum class Placement : std::size_t {
  kRaw,        ///< as if all had been measured at that time
  kDeskewed,   ///< preprocess::ScanMotion from IMU readings and the localizer's own state
  kTrueState,  ///< likewise from the true velocity, attitude and biases
  kTruePoses,  ///< by the true pose of each point's own time
};
constexpr std::size_t kPlacements = 4;

/// How far the points of a scan, placed in one way and then by the true pose of the last point, lie
/// from where they belong. Means of absolute values in metres; NaN without points.
struct PlacementError {
  /// From the plane of the surface that the ray met: returns from the static world that lie
  /// kClearOfEdgesM or more from all true edges.
  double off_surface_m = 0;
  /// The same for points whose ranges have no noise: what the placement alone does wrong.
  double off_surface_exact_m = 0;
  /// Along the surface, at right angles to the nearest true edge: returns within kAtEdgeM of one.
  double across_edge_m = 0;
};

constexpr double kClearOfEdgesM = 0.15;
constexpr double kAtEdgeM = 0.05;

using PlacementErrors = std::array<PlacementError, kPlacements>;

/// Errors of one scan of `drive` in all placements. `imu` covers the scan, `estimated` is what the
/// localizer knows at its end.
PlacementErrors placement_errors(const Scan& scan, simulation::Simulation& drive,
                                 const preprocess::ImuSegment& imu,
                                 const preprocess::EndState& estimated);

/// What ScanMotion needs to know, as it truly is at `t`.
preprocess::EndState true_end_state(const simulation::Simulation& drive, TimeNs t);

}  // namespace holdfast::benchmarks
