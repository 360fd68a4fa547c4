#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/core/se3.hpp"

namespace holdfast::simulation {

/// What happens to the robot during a simulated drive.
enum class EventKind {
  kBlind,        ///< no ray returns during the interval: empty clouds
  kLidarOff,     ///< no scan that would have measured within the interval: no messages
  kImuOff,       ///< no IMU sample within the interval: no messages
  kImuBiasJump,  ///< both IMU biases jump by fixed sizes in a direction drawn per seed, and stay
  kKidnap,     ///< the body stands at another place of the route at once and the IMU feels nothing;
               ///< with a duration it is carried there, the LiDAR covered, and the IMU feels it all
  kClockJump,  ///< the LiDAR's clock steps by a size drawn per seed, for good or for a while
  kCrowd,      ///< people walk round and with the robot, so near that they hide most of the world
};

/// An event that was asked for; times count from the start of the log.
struct EventSpec {
  EventKind kind = EventKind::kBlind;
  TimeNs start = 0;
  TimeNs duration = 0;  ///< zero for events that happen at an instant
};

/// An event that took place; times are absolute.
struct SimulatedEvent {
  EventKind kind = EventKind::kBlind;
  TimeNs t0 = 0;
  TimeNs t1 = 0;
  bool carried = false;                                       ///< of a kidnap: t0 < t1
  SE3 pose_before;                                            ///< T_map_body at t0, before a kidnap
  SE3 pose_after;                                             ///< T_map_body at t1, after a kidnap
  Eigen::Vector3d gyro_step_rad_s = Eigen::Vector3d::Zero();  ///< of an imu_bias_jump
  Eigen::Vector3d accel_step_m_s2 = Eigen::Vector3d::Zero();  ///< of an imu_bias_jump
  double clock_step_s = 0;  ///< of a clock_jump: what the LiDAR's clock is ahead of before
};

/// Name on the command line and in events.jsonl: "blind", "lidar_off", "imu_off", "imu_bias_jump",
/// "kidnap", "clock_jump", "crowd".
std::string_view event_name(EventKind kind);

/// Names of all events, in the order of EventKind.
std::vector<std::string_view> event_names();

/// Parses `NAME@T0[+DURATION]`, seconds from the start of the log. `blind`, `lidar_off` and
/// `imu_off` without a duration last 2 s, a `crowd` 10 s; a `kidnap` without one happens at T0; a
/// `clock_jump` without one is for good, with one the clock steps back after it; an `imu_bias_jump`
/// takes none. The error lists the known names or shows the form expected.
Result<EventSpec> parse_event(const std::string& text);

/// One line of events.jsonl, without the end of line: t0 and t1 in seconds with 9 decimals, the
/// name, and what belongs to the kind (poses and size of a kidnap, steps of a bias or clock jump).
std::string event_json(const SimulatedEvent& event);

}  // namespace holdfast::simulation
