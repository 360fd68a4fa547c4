#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/files/event_file.hpp"
#include "evaluation/scan_list.hpp"

namespace holdfast::evaluation {

/// How far a pose may be off.
struct PoseTolerance {
  double trans_m;
  double rot_deg;

  /// False for errors that are not known.
  bool holds(const ScanRecord& scan) const {
    return scan.trans_error_m <= trans_m && scan.rot_error_deg <= rot_deg;
  }
};

/// Trusted (TRACKING or DEGRADED) and beyond `tolerance` wrong, in DEGRADED only in a direction
/// that it did not declare uncertain.
bool is_misleading(const ScanRecord& scan, const PoseTolerance& tolerance);

/// How a run came through one event.
struct EventScore {
  Event event;
  double moved_m = kNotKnown;  ///< kidnap: how far the robot was carried
  double moved_deg = kNotKnown;
  /// From the start to the first scan without a trusted status; none: never left TRACKING,
  /// DEGRADED.
  std::optional<double> noticed_after_s;
  /// From the end of the event (of kidnap, blind, lidar_off, imu_off, crowd) or its start
  /// (imu_bias_jump, clock_jump) to the first scan in TRACKING within the tolerance of success that
  /// stays so for 2 s and at least 18 scans. None: not before the end of the run or the next
  /// kidnap.
  std::optional<double> recovery_s;
  /// From the start to the recovery (or the end): claims, and those trusted and wrong.
  double worst_claim_m = kNotKnown;
  std::size_t misleading_scans = 0;
};

/// True for the names of DESIGN.md's simulated events.
bool is_simulated_event(const std::string& name);

/// Scores the simulated events among `events`, in order; others are left out.
std::vector<EventScore> score_events(const std::vector<Event>& events,
                                     const std::vector<ScanRecord>& scans, const TruthTrack& truth,
                                     const PoseTolerance& success, const PoseTolerance& misleading);

/// One relocalization that the run reported, and how wrong the pose was that it accepted.
struct RelocalizationScore {
  TimeNs t = 0;
  double trans_error_m = kNotKnown;  ///< of the first claim within 1 s of the event
  double rot_error_deg = kNotKnown;
};

/// Scores the "relocalized" events that a run wrote.
std::vector<RelocalizationScore> score_relocalizations(const std::vector<Event>& run_events,
                                                       const std::vector<ScanRecord>& scans);

}  // namespace holdfast::evaluation
