#pragma once

#include <vector>

#include "holdfast/core/time.hpp"
#include "simulation/motion/route.hpp"

namespace holdfast::simulation {

/// One ride of a robot in a lift.
struct Ride {
  TimeNs begin = 0;          ///< when the robot has come to rest; from the start of the log
  Eigen::Vector3d position;  ///< of the route before the ride
  double heading = 0;        ///< of the robot, rad
  double rise_m = 0;         ///< upwards; below 0 down
};

inline constexpr double kRideSpeed = 1.0;         ///< m/s
inline constexpr double kRideAcceleration = 0.6;  ///< m/s^2
inline constexpr double kRideWait = 4.0;          ///< s at rest before and after

/// How far a lift has gone `seconds` after the robot came to rest in it, to `rise_m`: it waits,
/// then sets off with the acceleration, goes at the speed if the way is long enough, stops
/// likewise.
double ride_height(double rise_m, double seconds);

/// Seconds from coming to rest until the lift has arrived, and until the robot drives on.
double ride_arrival(double rise_m);
double ride_end(double rise_m);

/// `s`, or the next place of a route that is far enough from its lifts for a drive to begin there.
double off_lifts(const Route& route, double s);

/// Takes a robot that drives along routes up and down where they say so. Asked and told tick by
/// tick, by the planner of a drive.
class RideControl {
 public:
  /// How fast the robot may be at `s` so that it can stop for the next ride, in m/s; infinite
  /// without one. 0 while it rides.
  double speed_limit(const Route& route, double s, double acceleration) const;
  /// Begins a ride if the robot has come to rest where the next one is, and ends one in time.
  void watch(TimeNs t, const Route& route, double s, double speed);
  /// The robot is elsewhere, on another route or another part of it.
  void leave(TimeNs t);

  bool is_riding() const { return riding_; }
  /// Metres by which rides have lifted the robot so far since the start of the log.
  double height(TimeNs t) const;
  const std::vector<Ride>& rides() const { return rides_; }

 private:
  double next_ride(const Route& route, double s) const;

  std::vector<Ride> rides_;
  bool riding_ = false;
  double before_ = 0;         ///< height before the ride that goes on
  double done_until_ = -1e9;  ///< no ride at or before this place of the route is to come
};

}  // namespace holdfast::simulation
