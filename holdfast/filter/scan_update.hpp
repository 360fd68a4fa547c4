#pragma once

#include <vector>

#include "holdfast/core/parallel.hpp"
#include "holdfast/core/stage_clock.hpp"
#include "holdfast/filter/filter_state.hpp"
#include "holdfast/filter/map_error.hpp"
#include "holdfast/map/prior_map.hpp"
#include "holdfast/preprocess/deskew.hpp"
#include "holdfast/registration/normal_equations.hpp"

namespace holdfast::filter {

/// A scan that is ready to be matched: which points, and the readings that its motion follows from.
struct SelectedScan {
  const Scan* scan = nullptr;
  std::vector<std::uint32_t> selected;  ///< indices into scan->points
  preprocess::ImuSegment imu;           ///< covers [stamp, end_time]
  SE3 T_body_lidar;
};

/// How one pass over a scan is done.
struct UpdateOptions {
  registration::AssociationOptions association;
  double robust_scale = 3.0;  ///< of the Geman-McClure loss, in sigmas
  int max_iterations = 6;
  double map_sigma_m = 0.001;     ///< error of the map common to a whole scan, position
  double map_sigma_rad = 0.0001;  ///< and rotation
  /// Let the velocity follow from the skew of the scan too: needed where nothing else tells it (a
  /// start on the move); otherwise the prediction knows it far better.
  bool velocity_from_skew = false;
};

/// The map's own error in a scan that lasts `span_s` and has these equations: over its time it may
/// change by as much as it is, and part of the information may be feigned.
MapError map_error(const UpdateOptions& options, double span_s,
                   const registration::NormalEquations& equations);

/// What an update found.
struct UpdateResult {
  registration::NormalEquations equations;  ///< at the last linearisation
  int iterations = 0;
  bool usable = false;  ///< enough agreeing pairs to have updated the state
};

/// Buffers that keep their memory from scan to scan.
struct UpdateWorkspace {
  preprocess::ScanMotion motion;
  registration::BodyPoints points;
  registration::Correspondences pairs;
  std::vector<registration::NormalEquations> partials;
};

/// A map to pair points with, whatever holds its surfaces.
class ScanPairing {
 public:
  virtual ~ScanPairing() = default;
  virtual Eigen::Vector3d anchor() const = 0;
  /// registration::associate.
  virtual std::size_t associate(const SE3& T_anchor_body, const Eigen::Vector3d& p_body_lidar,
                                const registration::BodyPoints& points,
                                const registration::AssociationOptions& options, WorkerPool& pool,
                                registration::Correspondences& out) const = 0;
};

/// Pairing with a map that registration::associate was made for.
template <registration::SurfaceMap Map>
class PairingWith final : public ScanPairing {
 public:
  explicit PairingWith(const Map& map) : map_(map) {}
  Eigen::Vector3d anchor() const override { return map_.anchor(); }
  std::size_t associate(const SE3& T_anchor_body, const Eigen::Vector3d& p_body_lidar,
                        const registration::BodyPoints& points,
                        const registration::AssociationOptions& options, WorkerPool& pool,
                        registration::Correspondences& out) const override {
    return registration::associate(map_, T_anchor_body, p_body_lidar, points, options, pool, out);
  }

 private:
  const Map& map_;
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
