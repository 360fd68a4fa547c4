#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/core/se3.hpp"

namespace holdfast {

/// What the system says of itself after each scan.
enum class State : std::uint8_t {
  kInitializing,   ///< not yet known where; nothing is claimed
  kTracking,       ///< pose known in all directions
  kDegraded,       ///< pose known, but not in the directions named
  kDeadReckoning,  ///< no usable scan; IMU (and odometry) carry the pose on
  kUnmapped,       ///< outside of the map; odometry carries the pose on
  kSuspect,        ///< something disagrees; the pose may be wrong
  kLost,           ///< not known where; nothing is claimed
  kRelocalizing,   ///< searching; nothing is claimed
};

/// "TRACKING", "DEGRADED", ...: the words of the files.
std::string_view to_string(State state);

/// True in the states in which a line of trajectory.tum is written.
constexpr bool claims_pose(State state) {
  return state != State::kInitializing && state != State::kLost && state != State::kRelocalizing;
}

/// The work of a step, in order. Names of the ms_ columns of steps.csv.
enum class Stage : std::uint8_t {
  kStart,
  kOdometry,  ///< all of an odometry that runs beside a localizer
  kSelect,
  kPredict,
  kDeskew,
  kAssociate,
  kSolve,
  kHealth
};
constexpr std::array<std::string_view, 8> kStageNames = {"start",  "odometry",  "select", "predict",
                                                         "deskew", "associate", "solve",  "health"};

/// Thread CPU time of one step, ms.
struct StageTimes {
  std::array<double, kStageNames.size()> ms{};
  double total_ms = 0;
  double wall_ms = 0;

  StageTimes& operator+=(const StageTimes& other) {
    for (std::size_t i = 0; i < ms.size(); ++i) ms[i] += other.ms[i];
    total_ms += other.total_ms;
    wall_ms += other.wall_ms;
    return *this;
  }
};

/// A search of the whole map for the robot's pose (article 3.4.2), as the report of the step tells
/// it in which it took effect.
struct SearchSummary {
  struct Candidate {
    SE3 T_map_body;          ///< at the time of the search's newest scan
    double score = 0;        ///< of the search on the grid
    double agreeing = 0;     ///< mean robust weight of the points, once refined
    double probability = 0;  ///< among all candidates, and that it is none of them
  };

  TimeNs t = 0;                       ///< of the newest scan that was searched with
  int scans = 0;                      ///< that was done with
  std::string outcome;                ///< "found", "ambiguous", "nothing", ...
  std::string reason;                 ///< a sentence
  std::vector<Candidate> candidates;  ///< the likeliest first
  std::uint64_t work = 0;             ///< look-ups
  double latency_s = 0;               ///< by the work: from `t` until it took effect, or could have
  double cpu_ms = 0;                  ///< as measured; nothing depends on it
  bool accepted = false;              ///< the pose was taken over
};

/// What one witness says of the pose.
struct Evidence {
  std::string_view witness;  ///< "fitting", "paired", "through", "unmapped", "way", "sudden", ...
  double log_ratio = 0;      ///< ln of how much more likely it is at a wrong pose; > 0: against it
  std::string text;          ///< in a few words, with figures
};

/// What came of one scan.
struct StepReport {
  TimeNs stamp = 0;      ///< time of the scan's first point
  TimeNs pose_time = 0;  ///< time of its last point
  State state = State::kInitializing;
  std::string reason;              ///< why this state, in a few words; empty for plain TRACKING
  SE3 T_map_body;                  ///< at pose_time; meaningful where claims_pose(state)
  SE3 T_map_predicted;             ///< what motion alone would have given
  double p_wrong = -1;             ///< probability that the pose is wrong; < 0: not estimated
  bool alarm = false;              ///< the monitor holds the pose for suspect or lost
  std::vector<Evidence> evidence;  ///< while it does: all witnesses, the strongest first
  int matches = 0;                 ///< points paired with a surface of the map
  double inlier_share = 0;         ///< share of the selected points that agree with the map
  double mean_abs_residual_m = 0;  ///< mean distance of the agreeing points to their surfaces
  std::vector<Eigen::Vector3d> weak_directions;  ///< unit vectors in the map frame
  double sigma_trans_m = 0;  ///< largest standard deviation of the position, any direction
  double sigma_rot_rad = 0;  ///< likewise of the rotation
  /// Covariance of the error of T_map_body as [position in the map frame (m), rotation perturbed on
  /// the right (rad)]; the two sigmas above are of its diagonal blocks. Zero: not estimated.
  Eigen::Matrix<double, 6, 6> pose_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  int odom_epoch = 0;
  std::shared_ptr<const SearchSummary> search;  ///< of the map, that ended with this step
  TimeNs imu_held_ns = 0;  ///< part of the step for which the last IMU reading was held
  StageTimes times;
};

}  // namespace holdfast
