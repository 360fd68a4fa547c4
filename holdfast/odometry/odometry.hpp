#pragma once

#include <optional>

#include "holdfast/filter/rest.hpp"
#include "holdfast/odometry/bias_jump.hpp"
#include "holdfast/odometry/edges/edge_reference.hpp"
#include "holdfast/odometry/gravity_estimate.hpp"
#include "holdfast/odometry/odometry_config.hpp"
#include "holdfast/odometry/odometry_report.hpp"
#include "holdfast/odometry/start/first_motion.hpp"
#include "holdfast/preprocess/scan_selection.hpp"

namespace holdfast::odometry {

/// LiDAR-inertial odometry: an iterated error-state filter with IMU prediction, matched to a local
/// map of planes that it makes itself. It takes nothing from a prior map: as a witness it must not
/// share an error with it. The frame `odom` has its origin at the body at the end of the first
/// scan, z against gravity and the body's heading as x.
///
/// It breaks where a scan contradicts the prediction and the local map alike (the robot was
/// carried), and after a time without usable scans that the IMU cannot bridge: then a new local map
/// begins, `odom_epoch` counts up, and the pose goes on from the prediction, which is as wrong as
/// the carrying was far.
///
/// Same calls, same bits, for any number of threads. Not thread-safe. Memory is fixed.
class Odometry {
 public:
  struct Setup {
    OdometryConfig odometry;
    LocalMapConfig map;
    filter::ImuNoiseConfig imu;
    preprocess::ScanSelectionConfig selection;  ///< max_points: OdometryConfig's
    double range_sigma_m = 0.02;
    double fastest_m_s = 15.0;  ///< that the robot may have at the start
    double gravity_m_s2 = 9.81;
    SE3 T_body_lidar;
    int threads = 1;
  };

  explicit Odometry(const Setup& setup);

  /// Readings in ascending order; others are refused and counted.
  void add_imu(const ImuSample& sample) { imu_.add(sample); }

  /// The pose at the scan's last point. IMU up to that time should have been added; where it was
  /// not, the last reading is held and the report says for how long.
  OdometryReport add_scan(const Scan& scan);

  /// Forgets all but the IMU's readings: the next scan is the first of a new epoch, with gravity
  /// and biases unknown, as when it was switched on. For what it cannot know itself: that nothing
  /// fits what it says.
  void begin_anew();

  /// Whether edges tell the way where planes do not, at the price of 2 ms a scan there: at first
  /// they do.
  void use_edges(bool on) { edges_on_ = on; }

  const filter::FilterState& state() const { return state_; }
  /// In the odometry's frame, m/s^2; along -z but for the error of the first levelling.
  const Eigen::Vector3d& gravity() const { return gravity_.value(); }
  /// Standard deviation of its direction, rad, the larger of the two axes.
  double gravity_sigma_rad() const {
    return gravity_.sigma().head<2>().maxCoeff() / gravity_.value().norm();
  }
  const LocalMap& map() const { return map_; }
  /// Of the newest scan, in the body frame at its end.
  const registration::BodyPoints& points() const { return work_.points; }
  const preprocess::ImuBuffer& imu() const { return imu_; }

 private:
  static constexpr TimeNs kImuMemory = 2 * kSecond;
  static constexpr int kLinesOfAPlane = 2;  ///< once the motion is known well

  enum class Phase { kNothing, kWaiting, kFirstScan, kRunning };

  /// From one scan to the next: the state there, and carried here by the IMU.
  struct Passage {
    filter::FilterState before;
    filter::FilterState predicted;
    GravityEstimate gravity_before;
    filter::Matrix15d now_before;  ///< covariance of the errors now (rows) and before
  };

  void step(const Scan& scan, StageClock& clock, OdometryReport& report);
  bool prepare(const Scan& scan, StageClock& clock, OdometryReport& report);
  void level(const Scan& scan);
  void wait_for_returns(OdometryReport& report);
  Passage pass(OdometryReport& report);
  void keep_first_scan();
  void find_edges(std::vector<SeenEdge>& edges);
  void allow_for_climb();
  void second_scan(StageClock& clock, OdometryReport& report);
  void track(StageClock& clock, OdometryReport& report);
  filter::Matrix15d predict(TimeNs to, OdometryReport& report);
  filter::UpdateResult correct(StageClock& clock);
  filter::UpdateResult correct_at(int level, const filter::FilterState& predicted,
                                  StageClock& clock);
  filter::UpdateResult release_biases(const filter::UpdateResult& update, Passage& passage,
                                      StageClock& clock, OdometryReport& report);
  void hear(const filter::UpdateResult& update, const Passage& passage);
  void allow_for(const BiasJump& jump, Passage& passage);
  void keep_what_is_left(const filter::UpdateResult& update, Passage& passage) const;
  void correct_by_edges(const filter::UpdateResult& update, Passage& passage);
  double surprise(const filter::FilterState& predicted) const;
  bool contradicted(const filter::UpdateResult& update, double surprise);
  void accept(const filter::UpdateResult& update, Passage& passage, StageClock& clock,
              OdometryReport& report);
  void extend_map();
  void begin_epoch(const char* reason, OdometryReport& report);
  void add_increment(const Passage& passage, OdometryReport& report);
  void describe(const filter::UpdateResult& update, OdometryReport& report) const;
  filter::UpdateOptions options() const;

  Setup setup_;
  GravityEstimate gravity_;
  BiasJumpWatch jumps_;
  filter::Rest rest_;
  LocalMap map_;
  WorkerPool pool_;
  preprocess::ImuBuffer imu_;
  preprocess::ImuSegment segment_;
  filter::UpdateWorkspace work_;
  filter::SelectedScan scan_;
  FirstScan first_;
  EdgeFinder edge_finder_;
  EdgeReference edge_reference_;
  bool edges_on_ = true;
  std::vector<SeenEdge> edges_;
  filter::FilterState state_;
  Phase phase_ = Phase::kNothing;
  std::uint64_t scan_number_ = 0;
  int epoch_ = 0;
  int keyframes_ = 0;         ///< of this epoch
  bool settled_ = false;      ///< the motion is known well, and the map by it
  int contradictions_ = 0;    ///< scans in a row
  double usual_share_ = 0;    ///< of inliers, running mean
  double usual_through_ = 0;  ///< of points behind walls, likewise
  SE3 last_keyframe_;
  Matrix6d drift_ = Matrix6d::Zero();  ///< covariance of T_odom_body since the epoch began
  double sigma_at_scan_m_ = 0;         ///< position, when a scan last told it
  TimeNs last_surprise_ = 0;
  std::optional<filter::FilterState::Biases> biases_before_hold_;  ///< while the IMU is silent
};

}  // namespace holdfast::odometry
