#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "holdfast/core/fields.hpp"
#include "simulation/motion/rides.hpp"
#include "simulation/motion/route.hpp"
#include "simulation/motion/trajectory.hpp"

namespace holdfast::simulation {

/// How a robot drives along a route.
struct DriveStyle {
  double speed_m_s = 1.2;          ///< nominal; each drive varies it by up to 10 % as it goes
  double acceleration_m_s2 = 0.6;  ///< along the way, speeding up and braking
  double yaw_rate_rad_s = 1.0;     ///< slows down in turns to keep within this
  double lateral_m_s2 = 1.5;       ///< and within this
  double rest_s = 2.0;             ///< standing still at the start
  double distance_m = 100.0;       ///< where the drive ends when no duration is given
  double body_height_m = 0.45;     ///< of the IMU above the ground
  double weave_m = 0.08;           ///< amplitude of slow deviations to the side
  double weave_length_m = 7;       ///< of their shortest wave; the longest is 25 / 7 of it
  double sway_rad = 0.003;         ///< amplitude of roll and pitch oscillation at nominal speed
  double heave_m = 0.002;          ///< amplitude of vertical oscillation at nominal speed
  double wobble_rad = 0;           ///< amplitude of roll, pitch and yaw at 1 to 3 Hz while moving

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("speed_m_s", self.speed_m_s, FieldDoc{"nominal speed", 0.05, 50});
    visit("acceleration_m_s2", self.acceleration_m_s2,
          FieldDoc{"along the way, speeding up and braking", 0.01, 20});
    visit("yaw_rate_rad_s", self.yaw_rate_rad_s,
          FieldDoc{"the robot slows down in turns to keep within this", 0.01, 10});
    visit("lateral_m_s2", self.lateral_m_s2, FieldDoc{"and within this", 0.01, 20});
    visit("rest_s", self.rest_s, FieldDoc{"standing still at the start", 0, 1000});
    visit("distance_m", self.distance_m,
          FieldDoc{"where the drive ends when no duration is given", 1, 1e6});
    visit("body_height_m", self.body_height_m, FieldDoc{"of the IMU above the ground", 0, 10});
    visit("weave_m", self.weave_m, FieldDoc{"amplitude of slow deviations to the side", 0, 10});
    visit("weave_length_m", self.weave_length_m, FieldDoc{"of their shortest wave", 0.1, 1000});
    visit("sway_rad", self.sway_rad,
          FieldDoc{"amplitude of roll and pitch oscillation at nominal speed", 0, 0.5});
    visit("heave_m", self.heave_m,
          FieldDoc{"amplitude of vertical oscillation at nominal speed", 0, 0.5});
    visit("wobble_rad", self.wobble_rad,
          FieldDoc{"amplitude of roll, pitch and yaw at 1 to 3 Hz while moving", 0, 0.52});
  }

  /// The same way at `factor` times the speed; turning rate and accelerations grow likewise.
  DriveStyle faster(double factor) const;
};

/// An instant change of the pose.
struct Teleport {
  TimeNs t = 0;
  SE3 before;  ///< T_map_body
  SE3 after;
};

/// The true motion of the body over a log; times count from the start of the log.
class Drive {
 public:
  /// Plans a drive that differs by seed in start, direction, line, speed and oscillation. At each
  /// of the (ascending) `kidnaps` the body stands at another place of the route, >= 3 m or >= 45
  /// degrees away, with the same tilt, body-frame velocity and acceleration, so that an IMU notices
  /// nothing.
  static Drive plan(const Route& route, const DriveStyle& style, std::uint64_t seed,
                    std::optional<TimeNs> duration, const std::vector<TimeNs>& kidnaps);

  /// Motion at `t`, clamped to [0, duration()]; at a teleport the motion after it.
  MotionState at(TimeNs t) const;
  TimeNs duration() const { return duration_; }
  const std::vector<Teleport>& teleports() const { return teleports_; }
  /// In lifts, in order.
  const std::vector<Ride>& rides() const { return rides_; }

 private:
  Drive() = default;
  std::vector<Trajectory> pieces_;  ///< one more than teleports
  std::vector<Teleport> teleports_;
  std::vector<Ride> rides_;
  TimeNs duration_ = 0;
};

}  // namespace holdfast::simulation
