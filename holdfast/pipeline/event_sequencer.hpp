#pragma once

#include <deque>

#include "holdfast/core/sensor_data.hpp"

namespace holdfast::pipeline {

/// Puts sensor events into the order in which a Localizer wants them: a scan waits until an IMU
/// reading at or after its last point has come. When the IMU has stopped, the scan is let go once
/// the log has moved on by `patience` past its end.
class EventSequencer {
 public:
  explicit EventSequencer(TimeNs patience = kSecond / 10) : patience_(patience) {}

  /// Takes the next event of the log.
  void push(SensorEvent event);
  /// No more events will come: everything still waiting is ready.
  void finish() { finished_ = true; }
  /// Moves the next ready event to `event`; false if none is ready.
  bool pop(SensorEvent& event);

 private:
  bool scan_is_ready(const Scan& scan) const;

  TimeNs patience_;
  std::deque<SensorEvent> ready_;
  std::deque<Scan> waiting_;  ///< by end_time
  TimeNs imu_until_ = INT64_MIN;
  TimeNs log_until_ = INT64_MIN;
  bool finished_ = false;
};

}  // namespace holdfast::pipeline
