#pragma once

#include "holdfast/filter/filter_state.hpp"
#include "holdfast/filter/matching/scan_match.hpp"

namespace holdfast::filter {

/// What an update found.
struct UpdateResult {
  registration::NormalEquations equations;  ///< at the last linearisation
  int iterations = 0;
  bool usable = false;  ///< enough agreeing pairs to have updated the state
};

/// Iterated update with one scan: Gauss-Newton, from `state`, on `prior` (a prediction at the
/// scan's end, with its covariance) and all point-to-plane residuals. The residuals depend on the
/// velocity too, since it moved the points during the scan; so a single scan can tell the velocity
/// of a robot that starts on the move (UpdateOptions::velocity_from_skew). The map's own error is
/// common to all points of a scan: a pose offset with `map_sigma` is marginalised out, which caps
/// the information however many points there are.
UpdateResult update_with_scan(const ScanPairing& map, const SelectedScan& scan,
                              const Eigen::Vector3d& gravity, const UpdateOptions& options,
                              WorkerPool& pool, UpdateWorkspace& work, const FilterState& prior,
                              FilterState& state, StageClock* clock);

/// The same with a map itself.
template <registration::SurfaceMap Map>
UpdateResult update_with_scan(const Map& map, const SelectedScan& scan,
                              const Eigen::Vector3d& gravity, const UpdateOptions& options,
                              WorkerPool& pool, UpdateWorkspace& work, const FilterState& prior,
                              FilterState& state, StageClock* clock) {
  return update_with_scan(PairingWith<Map>(map), scan, gravity, options, pool, work, prior, state,
                          clock);
}

}  // namespace holdfast::filter
