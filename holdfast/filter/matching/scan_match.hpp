#pragma once

#include <vector>

#include "holdfast/core/parallel.hpp"
#include "holdfast/core/stage_clock.hpp"
#include "holdfast/filter/matching/map_error.hpp"
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

/// The same scan with at most `most` points, spread evenly over those selected.
SelectedScan thinned(const SelectedScan& scan, std::size_t most);

/// How one pass over a scan is done.
struct UpdateOptions {
  registration::AssociationOptions association;
  double robust_scale = 3.0;  ///< of the Geman-McClure loss, in sigmas
  int max_iterations = 6;
  double few_pairs = 20;          ///< so many pairs cannot prove a direction alone (degeneracy.hpp)
  double map_sigma_m = 0.001;     ///< error of the map common to a whole scan, position
  double map_sigma_rad = 0.0001;  ///< and rotation
  /// Let the velocity follow from the skew of the scan too: needed where nothing else tells it (a
  /// start on the move); otherwise the prediction knows it far better.
  bool velocity_from_skew = false;
  /// Let the velocity and both biases follow from it: while the IMU is silent or contradicts the
  /// scans (ScanMatch::linearise).
  bool motion_from_skew = false;
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

/// The pose and what else the residuals of a scan depend on, at the scan's last point.
struct MatchState {
  SE3 T_map_body;
  Eigen::Vector3d v_map = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d gravity_map = Eigen::Vector3d(0, 0, -9.81);
};

/// Puts the selected points into the body frame of the scan's end, given that the body moved as `x`
/// says: into `work.points`.
void deskew_scan(const SelectedScan& scan, const MatchState& x, UpdateWorkspace& work);

/// Matches one scan to a map again and again while an optimisation moves its pose: deskews
/// and pairs the points anew only where the state has moved so far that it matters.
class ScanMatch {
 public:
  ScanMatch(const ScanPairing& map, const SelectedScan& scan, const UpdateOptions& options,
            WorkerPool& pool, UpdateWorkspace& work, StageClock* clock)
      : map_(map), scan_(scan), options_(options), pool_(pool), work_(work), clock_(clock) {}

  /// Normal equations at `x`, softened by the map's own error. The robust loss starts wide and
  /// narrows from call to call: kCalls calls until it is as narrow as the options say.
  ///
  /// `by_skew`: for a robot whose motion is not known from its IMU. While that is silent, or its
  /// biases were let go, the skew of a scan depends on the very motion that the scan is to tell.
  /// Taken as known, a wrong velocity or rate would move the pose, and the pose the next velocity,
  /// to and fro and ever farther. Deskews and pairs anew in each call.
  static constexpr int kCalls = 3;
  ScanEquations linearise(const MatchState& x, bool by_skew);

  /// Pose and velocity of the last call, without the map's own error.
  const registration::NormalEquations& raw() const { return raw_; }

 private:
  void deskew(const MatchState& x);
  void pair(const MatchState& x);
  bool is_stale(const MatchState& x) const;
  void refresh(const MatchState& x, bool by_skew);
  ScanEquations without_skew(const MatchState& x) const;
  MapError map_error() const;
  double span_s() const;
  void book(Stage stage);

  const ScanPairing& map_;
  const SelectedScan& scan_;
  const UpdateOptions& options_;
  WorkerPool& pool_;
  UpdateWorkspace& work_;
  StageClock* clock_;
  MatchState deskewed_;
  SE3 paired_;
  int calls_ = 0;
  registration::NormalEquations raw_;
};

}  // namespace holdfast::filter
