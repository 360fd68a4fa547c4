#pragma once

#include <memory>
#include <optional>

#include "baselines/map_filter.hpp"
#include "holdfast/estimator/fixed_lag_smoother.hpp"
#include "holdfast/filter/matching/patch_error.hpp"
#include "holdfast/filter/matching/point_demand.hpp"
#include "holdfast/filter/matching/scan_match.hpp"
#include "holdfast/pipeline/graph/graph_config.hpp"
#include "holdfast/pipeline/graph/odometry_witness.hpp"
#include "holdfast/pipeline/graph/placement.hpp"
#include "holdfast/pipeline/health/map_health.hpp"
#include "holdfast/pipeline/methods/scan_localizer.hpp"

namespace holdfast::pipeline {

/// The default method (article 3.3): a fixed-lag graph over the last scans in which IMU, prior map
/// and odometry meet.
class GraphLocalizer : public ScanLocalizer {
 public:
  struct Setup {
    baselines::MapFilter::Setup start;  ///< matching, selection, noise; and the start itself
    estimator::SmootherConfig smoother;
    GraphConfig graph;
    odometry::Odometry::Setup odometry;
    std::optional<monitor::MonitorConfig> monitor;  ///< none: nobody asks whether the pose is right
    std::shared_ptr<const places::Places> places;   ///< of the map, for the monitor; may be null
  };

  /// `T_map_body` is the pose at the end of the first scan, to within Setup::start.
  GraphLocalizer(map::PriorMap map, const Setup& setup, const SE3& T_map_body);
  /// Without a pose: until place() tells one, the odometry alone listens, and nothing is claimed.
  GraphLocalizer(map::PriorMap map, const Setup& setup);

  void add_imu(const ImuSample& sample) override;
  StepReport add_scan(const Scan& scan) override;

  /// Goes on from a pose that a search found. Call it between scans, and only with an odometry.
  void place(const Placement& found);
  /// A search found the very pose that it has: what spoke against it is forgotten.
  void confirm();
  bool has_pose() const { return placed_; }
  /// Call it between scans, and only with an odometry.
  void restart_odometry() { witness_->restart(); }

  const estimator::FixedLagSmoother& smoother() const { return smoother_; }
  /// Null if the odometry is switched off.
  const OdometryWitness* witness() const { return witness_.get(); }

 private:
  static constexpr TimeNs kImuMemory = 2 * kSecond;

  /// What matching the newest scan gave.
  struct Match {
    registration::NormalEquations equations;  ///< of the scan alone
    estimator::OptimiseReport optimised;
    bool usable = false;
    double mapped_share = 1;  ///< of the returns, where the map has anything
  };

  /// What is kept of a node for when its IMU is back.
  struct ImuState {
    estimator::NodeState x;
    estimator::Matrix18d P;
  };

  StepReport start(const Scan& scan);
  void wait(StepReport& report);
  void take_over();
  void step(const Scan& scan, StageClock& clock, StepReport& report);
  bool prepare(const Scan& scan, StepReport& report);
  bool predict(TimeNs to, StepReport& report);
  void allow_for_silence();
  void restore_biases();
  Match match(const estimator::NodeState& predicted, StageClock& clock);
  Match match_finely(const filter::UpdateOptions& options, StageClock& clock);
  bool motion_is_open() const;
  bool lead_by_coarse_planes(const estimator::NodeState& predicted, double sigma_m,
                             StageClock& clock);
  void allow_for_bias_jump(Match& match, StageClock& clock);
  void carry_on_by_odometry(Match& match);
  double mapped_share(const SE3& T_map_body) const;
  filter::UpdateOptions options() const;
  void estimate_map_error(const Match& match);
  filter::Matrix6d pose_covariance() const;
  void describe(const Match& match, StepReport& report) const;
  void judge(const Match& match, StepReport& report);
  void ask_monitor(const map::PriorMap& map, const registration::BodyPoints& points,
                   StepReport& report);

  Setup setup_;
  std::unique_ptr<baselines::MapFilter> start_;  ///< until it has found the pose
  std::unique_ptr<map::PriorMap> map_;           ///< from then on
  bool placed_ = true;
  WorkerPool pool_;
  preprocess::ImuBuffer imu_;
  preprocess::ImuSegment segment_;
  filter::UpdateWorkspace work_;
  filter::PointDemand demand_;
  filter::SelectedScan scan_;
  filter::PatchError patches_;
  filter::Matrix6d map_error_ = filter::Matrix6d::Zero();  ///< of the last usable scan
  std::vector<Eigen::Vector3d> few_told_;                  ///< directions, likewise
  estimator::FixedLagSmoother smoother_;
  std::unique_ptr<OdometryWitness> witness_;        ///< none: switched off
  std::optional<MapHealth> health_;                 ///< none: switched off
  std::optional<estimator::BetweenFactor> motion_;  ///< since the node before, by the odometry
  double last_mapped_share_ = 1;
  std::uint64_t scan_number_ = 0;
  double travel_per_scan_m_ = 0;
  bool silent_ = false;                  ///< the IMU, for most of the newest interval
  std::optional<ImuState> before_hold_;  ///< while it is
};

}  // namespace holdfast::pipeline
