#pragma once

#include <cstdint>
#include <vector>

#include "simulation/events/event.hpp"
#include "simulation/events/time_span.hpp"
#include "simulation/motion/drive.hpp"
#include "simulation/sensors/imu/imu_sensor.hpp"
#include "simulation/transport/lidar_clock.hpp"

namespace holdfast::simulation {

/// Starts of all events of one kind, in order; from the start of the log.
std::vector<TimeNs> starts_of(EventKind kind, const std::vector<EventSpec>& events);

/// The events of a log by what they do; times from the start of the log.
struct EventSchedule {
  std::vector<TimeSpan> blind;
  std::vector<TimeSpan> lidar_off;
  std::vector<TimeSpan> imu_off;
  std::vector<BiasJump> bias_jumps;    ///< in order of time
  std::vector<ClockJump> clock_jumps;  ///< likewise

  /// Kidnaps are left to Drive::plan(). Directions of bias jumps and sizes of clock jumps are drawn
  /// from `seed`.
  EventSchedule(const std::vector<EventSpec>& events, const ImuModel& imu,
                const LidarClockModel& lidar_clock, std::uint64_t seed);

  /// What happened in a log that began at `epoch` and ended `length` later, in order of t0.
  std::vector<SimulatedEvent> took_place(const Drive& drive, TimeNs epoch, TimeNs length) const;
};

}  // namespace holdfast::simulation
