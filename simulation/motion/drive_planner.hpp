#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "holdfast/core/random.hpp"
#include "simulation/motion/drive.hpp"
#include "simulation/motion/person/carry.hpp"
#include "simulation/motion/person/gait.hpp"
#include "simulation/motion/rides.hpp"
#include "simulation/motion/speed_limit.hpp"

namespace holdfast::simulation {

/// Plans a drive in steps of one spline knot: how far the robot has gone at each tick, where that
/// is on the route (a new leg after each kidnap), and from that the control poses of each leg.
class DrivePlanner {
 public:
  DrivePlanner(const Route& route, const DriveStyle& style, std::uint64_t seed);

  /// Spans of time in which a drive that is yet to be planned goes no faster than a walking person.
  void slow_down_in(const std::vector<TimeSpan>& crowds) { crowds_ = crowds; }

  /// Drives until `duration`, or without one until the style's distance is gone and the robot
  /// rests. During each of the `carries` (ascending, apart from each other and from the `kidnaps`)
  /// it stops and is carried to another place.
  void drive(std::optional<TimeNs> duration, const std::vector<TimeNs>& kidnaps,
             const std::vector<TimeSpan>& carries);

  TimeNs duration() const { return duration_; }
  std::size_t legs() const { return legs_.size(); }
  TimeNs leg_start(std::size_t leg) const { return legs_[leg].start; }
  /// True for a leg that begins with being carried, false for one that begins with a teleport.
  bool is_carried(std::size_t leg) const { return legs_[leg].put_down > 0; }
  /// How long each of the carries that began must last at least; no leg begins with those that are
  /// shorter.
  const std::vector<TimeNs>& needed_for_carries() const { return needed_for_carries_; }
  /// Motion of each leg; a leg also covers some time before its start and after its end.
  std::vector<Trajectory> trajectories() const;
  const std::vector<Ride>& rides() const { return rides_.rides(); }

 private:
  struct Course {  ///< the route in one direction
    Route route;
    SpeedLimit limit;
  };
  struct Leg {
    TimeNs start;
    std::size_t course;
    double s;                  ///< on the course at the start of the leg
    double gone;               ///< metres since the start of the log
    std::size_t put_down = 0;  ///< tick until which the body is carried; 0: it is not
    double carried_m = 0;      ///< along the course of the leg before
    double lifted = 0;         ///< metres by which rides had lifted the robot until then
  };
  struct Wave {
    double frequency;
    double phase;
    double at(double x) const;
    double slope_at(double x) const;
  };
  using TwoWaves = std::array<Wave, 2>;
  using Controls = std::vector<PoseVector>;  ///< consecutive ticks from a leg's first_tick()

  static TwoWaves draw_waves(RandomStream& random, double longest, double shortest);
  double target_speed(TimeNs t, double gone, bool stop_at_distance) const;
  double crowd_limit(TimeNs t) const;
  void begin_leg(TimeNs t, double gone);
  bool pick_up(const TimeSpan& carry, std::size_t tick);
  std::vector<Leg> carry_candidates(std::size_t begin, std::size_t ticks, double gone_before) const;
  CarryPath carry_path(const Leg& from, const Leg& to) const;
  double course_difference(const Leg& from, const Leg& to, double gone) const;
  bool is_far(const Leg& from, const Leg& to) const;
  double place_on(const Leg& leg, double gone) const { return leg.s + gone - leg.gone; }
  double height_above_route(const Leg& leg, std::size_t tick) const;
  Route::Place place(const Leg& leg, double gone) const;
  PoseVector pose(const Leg& leg, double gone) const;
  std::size_t first_tick(std::size_t leg) const;
  std::size_t last_tick(std::size_t leg) const;
  Controls plain_controls(std::size_t leg) const;
  void join(std::size_t leg, const Controls& before, Controls& after) const;
  void carry(std::size_t leg, Controls& after) const;
  std::vector<double> speeds(std::size_t leg, double at_most) const;
  void add_sway(std::size_t leg, Controls& controls) const;
  void add_wobble(std::size_t leg, Controls& controls) const;
  void add_gait(std::size_t leg, Controls& controls) const;

  DriveStyle style_;
  std::vector<Course> courses_;
  std::vector<Leg> legs_;
  std::vector<double> gone_;    ///< at each tick
  std::vector<double> speed_;   ///< at each tick
  std::vector<double> lifted_;  ///< metres by which rides have, at each tick
  RideControl rides_;
  TimeNs duration_ = 0;
  std::vector<TimeSpan> crowds_;
  std::vector<TimeNs> needed_for_carries_;
  TwoWaves weave_{};
  TwoWaves pace_{};
  std::array<TwoWaves, 3> sway_{};    ///< heave, pitch, roll
  std::array<TwoWaves, 3> wobble_{};  ///< yaw, pitch, roll
  Gait gait_;
  RandomStream kidnap_random_;
};

}  // namespace holdfast::simulation
