#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "holdfast/core/fields.hpp"
#include "simulation/events/time_span.hpp"
#include "simulation/motion/rides.hpp"
#include "simulation/motion/route.hpp"
#include "simulation/motion/trajectory.hpp"

namespace holdfast::simulation {

/// How a robot drives along a route.
struct DriveStyle {
  double speed_m_s = 1.2;          ///< nominal; each drive varies it by pace_share as it goes
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
  double pace_share = 0.1;         ///< by how much of itself the speed varies
  double step_heave_m = 0;         ///< amplitude of a walking person's heave at 2 Hz
  double step_sway_m = 0;          ///< and of its sway to the sides at 1 Hz
  double gesture_rad = 0;          ///< quick turns of the yaw; half as far in pitch and roll
  double gesture_rad_s = 2.4;      ///< greatest rate of these turns
  bool turn_on_spot = false;       ///< stop at sharp corners, turn, go on

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
    visit("pace_share", self.pace_share,
          FieldDoc{"by how much of itself the speed varies", 0, 0.9});
    visit("step_heave_m", self.step_heave_m,
          FieldDoc{"amplitude of a walking person's heave at 2 Hz while moving", 0, 0.1});
    visit("step_sway_m", self.step_sway_m,
          FieldDoc{"amplitude of its sway to the sides at 1 Hz while moving", 0, 0.1});
    visit(
        "gesture_rad", self.gesture_rad,
        FieldDoc{"quick turns there and back: greatest angle of yaw; half of it in pitch and roll",
                 0, 1.2});
    visit("gesture_rad_s", self.gesture_rad_s, FieldDoc{"greatest rate of these turns", 0.1, 6});
    visit("turn_on_spot", self.turn_on_spot,
          FieldDoc{"stop at corners of more than 40 degrees, turn on the spot, go on; no weaving"});
  }

  /// The same way at `factor` times the speed; turning rate and accelerations grow likewise.
  DriveStyle faster(double factor) const;
  /// The same way in the hands of a walking person: 1 to 3 m/s, the body 1.2 m above the ground,
  /// steps, and turns of up to 3 rad/s about all axes.
  DriveStyle in_hand() const;
};

/// An instant change of the pose.
struct Teleport {
  TimeNs t = 0;
  SE3 before;  ///< T_map_body
  SE3 after;
};

/// A change of the pose in a person's hands: the robot stops, is lifted, carried along the route
/// and put down; in between the motion is continuous.
struct Carry {
  TimeSpan span;
  SE3 before;  ///< T_map_body at its begin, when the robot may still roll
  SE3 after;   ///< T_map_body at its end, standing
  /// 0 if it took place; else it did not, and this is how long it would have had to last.
  TimeNs needs = 0;
};

/// The true motion of the body over a log; times count from the start of the log.
class Drive {
 public:
  /// Plans a drive that differs by seed in start, direction, line, speed and oscillation. At each
  /// of the (ascending) `kidnaps` the body stands at another place of the route, >= 3 m or >= 45
  /// degrees away, with the same tilt, body-frame velocity and acceleration, so that an IMU notices
  /// nothing. In each of the (ascending) `carries` a person carries it to such a place; they must
  /// lie apart from each other and from the 2 s after a kidnap. In `crowds` it goes no faster than
  /// a walking person.
  static Drive plan(const Route& route, const DriveStyle& style, std::uint64_t seed,
                    std::optional<TimeNs> duration, const std::vector<TimeNs>& kidnaps,
                    const std::vector<TimeSpan>& carries = {},
                    const std::vector<TimeSpan>& crowds = {});

  /// Motion at `t`, clamped to [0, duration()]; at a teleport the motion after it.
  MotionState at(TimeNs t) const;
  TimeNs duration() const { return duration_; }
  const std::vector<Teleport>& teleports() const { return teleports_; }
  /// Those that began before the end.
  const std::vector<Carry>& carries() const { return carries_; }
  /// In lifts, in order.
  const std::vector<Ride>& rides() const { return rides_; }

 private:
  Drive() = default;
  std::vector<Trajectory> pieces_;
  std::vector<TimeNs> starts_;  ///< of the pieces but for the first
  std::vector<Teleport> teleports_;
  std::vector<Carry> carries_;
  std::vector<Ride> rides_;
  TimeNs duration_ = 0;
};

}  // namespace holdfast::simulation
