#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/drives/surveyed_drive.hpp"
#include "holdfast/core/step_report.hpp"

namespace holdfast::benchmarks {

/// A scan with what a detector may know of it, and the truth.
struct ScanHealth {
  TimeNs t = 0;
  bool wrong = false;    ///< more than 0.5 m or 5 degrees off (evaluation: misleading)
  bool trusted = false;  ///< TRACKING or DEGRADED
  bool moving = false;   ///< in truth
  bool alarm = false;    ///< of the monitor as configured
  double p_wrong = 0;
  // What the article's detector sees
  SE3 T_map_body, T_map_predicted;
  double mean_residual_m = 0;
  int matches = 0;
};

/// What was done to the robot, if anything.
enum class Mishap {
  kNone,       ///< the pose should stay right
  kKidnap,     ///< at MonitoredDrive::event
  kWrongStart  ///< the initial pose is of another place
};

struct MonitoredDrive {
  std::string what;  ///< name of the kind
  Mishap mishap = Mishap::kNone;
  TimeNs event = 0;  ///< of a kidnap: when the LiDAR sees the other place
  std::vector<ScanHealth> scans;
};

/// A kind of drives for detectors to be judged by.
struct DetectionCase {
  std::string name;
  Mishap mishap = Mishap::kNone;
  std::string event;         ///< as on the command line; empty: none
  double changed_share = 0;  ///< of the world since its survey
  /// Of a wrong start: where the robot is at this share of the drive, or, below 0, where it is but
  /// turned by 180 degrees.
  double start_share = 0;
};

/// Quiet drives, drives in which something happens that is no reason for an alarm, and drives in
/// which the pose becomes wrong.
std::vector<DetectionCase> detection_cases(double duration_s);

/// Drives a case in the world and map of `surveyed`, which was made from `spec`.
Result<MonitoredDrive> monitor_drive(const DetectionCase& what, const DriveSpec& spec,
                                     const SurveyedDrive& surveyed);

}  // namespace holdfast::benchmarks
