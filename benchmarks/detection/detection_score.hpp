#pragma once

#include <vector>

#include "benchmarks/detection/monitored_drive.hpp"
#include "evaluation/statistics.hpp"
#include "holdfast/monitor/dual_index.hpp"

namespace holdfast::benchmarks {

/// What a detector says of each scan of a drive.
using Alarms = std::vector<bool>;

/// The probability against a threshold.
Alarms alarms_by_probability(const MonitoredDrive& drive, double threshold);
/// The article's detector, as pipeline::DualIndexLocalizer runs it.
Alarms alarms_by_dual_index(const MonitoredDrive& drive, const monitor::DualIndexConfig& config);

/// How good a detector is over many drives.
///
/// An event is a pose that becomes wrong: after a kidnap, from a wrong start on (where the robot
/// claims a pose there), or by itself. It is found by the first alarm from then on, and missed if
/// none comes in 5 s of motion and the pose is still wrong then. What the robot does not get wrong
/// (a kidnap that it rides out, a wrong start that it refuses) is no event. An alarm is false when
/// the pose was right all the while and is so for the next second. After an event a drive is not
/// looked at any more.
struct DetectionScore {
  evaluation::Share missed;      ///< of the events
  std::vector<double> delays_s;  ///< of those found; a wrong start's counted in motion only
  std::size_t false_alarms = 0;
  double right_s = 0;          ///< time in which an alarm would have been false
  std::size_t misleading = 0;  ///< scans trusted and wrong before the alarm
  double longest_misleading_s = 0;

  void add(const MonitoredDrive& drive, const Alarms& alarms);
  DetectionScore& operator+=(const DetectionScore& other);
  double false_alarms_per_h() const;
};

}  // namespace holdfast::benchmarks
