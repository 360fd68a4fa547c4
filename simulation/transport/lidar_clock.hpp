#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "holdfast/core/sensor_data.hpp"
#include "simulation/events/event.hpp"
#include "simulation/events/time_span.hpp"
#include "simulation/transport/transport_model.hpp"

namespace holdfast::simulation {

/// A step of the LiDAR's clock.
struct ClockJump {
  static constexpr TimeNs kNever = std::numeric_limits<TimeNs>::max();

  TimeSpan span;    ///< ends never when the step is for good
  TimeNs step = 0;  ///< added to what the clock shows

  bool is_for_good() const { return span.end == kNever; }
};

/// The clock_jump events with their sizes, in order of time; size and sign are drawn from the
/// stream "lidar.clock_jump".
std::vector<ClockJump> draw_clock_jumps(const std::vector<EventSpec>& events,
                                        const LidarClockModel& model, std::uint64_t seed);

/// Turns the true times of scans into those that the LiDAR's clock shows. It is read once a scan,
/// at the first point, so that a jump takes effect with the first scan that begins after it; times
/// within a scan run at the clock's pace. Times count from the start of the log.
class LidarClock {
 public:
  LidarClock(const LidarClockModel& model, const std::vector<ClockJump>& jumps, std::uint64_t seed);

  double offset_s() const { return offset_s_; }  ///< ahead at the start of the log
  double drift_ppm() const { return drift_ppm_; }

  /// What it shows at the true time `t`, without jitter.
  TimeNs read(TimeNs t) const;

  /// Puts stamp, end_time and time offsets into the clock's time; `index` names the jitter.
  void stamp(Scan& scan, std::size_t index);

  /// The scan with its true times again: one that stamp() has made, or any other as it is.
  Scan in_true_time(const Scan& scan) const;

 private:
  bool is_true_;
  double jitter_sigma_s_;
  std::uint64_t seed_;
  std::vector<ClockJump> jumps_;
  double offset_s_;
  double drift_ppm_;
  std::map<TimeNs, TimeNs> true_stamps_;  ///< by the stamp that was given
};

}  // namespace holdfast::simulation
