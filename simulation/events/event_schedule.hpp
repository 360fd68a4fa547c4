#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/events/event.hpp"
#include "simulation/events/time_span.hpp"
#include "simulation/motion/drive.hpp"
#include "simulation/sensors/imu/imu_sensor.hpp"
#include "simulation/transport/lidar_clock.hpp"

namespace holdfast::simulation {

/// Starts of all events of one kind that happen at an instant, in order; from the start of the log.
std::vector<TimeNs> starts_of(EventKind kind, const std::vector<EventSpec>& events);

/// Spans of all events of one kind that last, in order; from the start of the log.
std::vector<TimeSpan> spans_of(EventKind kind, const std::vector<EventSpec>& events);

/// What is wrong with the events together, empty when nothing is: while the robot is carried, and
/// in the 2 s before and after, nothing else may take it away; nor within a crowd.
std::string clash(const std::vector<EventSpec>& events);

/// The events of a log by what they do; times from the start of the log.
struct EventSchedule {
  std::vector<TimeSpan> blind;
  std::vector<TimeSpan> lidar_off;
  std::vector<TimeSpan> imu_off;
  std::vector<TimeSpan> carries;  ///< kidnaps that take time, with the LiDAR covered
  std::vector<TimeSpan> crowds;
  std::vector<BiasJump> bias_jumps;    ///< in order of time
  std::vector<ClockJump> clock_jumps;  ///< likewise

  /// When the LiDAR sees nothing: blind, or covered while the robot is carried.
  std::vector<TimeSpan> dark() const;

  /// Kidnaps are left to Drive::plan(). Directions of bias jumps and sizes of clock jumps are drawn
  /// from `seed`.
  EventSchedule(const std::vector<EventSpec>& events, const ImuModel& imu,
                const LidarClockModel& lidar_clock, std::uint64_t seed);

  /// What happened in a log that began at `epoch` and ended `length` later, in order of t0.
  std::vector<SimulatedEvent> took_place(const Drive& drive, TimeNs epoch, TimeNs length) const;
};

}  // namespace holdfast::simulation
