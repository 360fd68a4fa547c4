#include "simulation/motion/rides.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace holdfast::simulation {
namespace {

constexpr double kStopSlack = 0.02;  // metres from the place of the ride at which the robot rests

}  // namespace

double ride_height(double rise_m, double seconds) {
  const double way = std::abs(rise_m);
  const double speed = std::min(kRideSpeed, std::sqrt(way * kRideAcceleration));
  const double gain = speed / kRideAcceleration;             // seconds of speeding up
  const double steady = speed > 0 ? way / speed - gain : 0;  // seconds at full speed
  const double t = std::clamp(seconds - kRideWait, 0.0, 2 * gain + steady);
  const double left = 2 * gain + steady - t;
  double gone = speed * (t - 0.5 * gain);
  if (t < gain) gone = 0.5 * kRideAcceleration * t * t;
  if (left < gain) gone = way - 0.5 * kRideAcceleration * left * left;
  return std::copysign(gone, rise_m);
}

double ride_arrival(double rise_m) {
  const double way = std::abs(rise_m);
  const double speed = std::min(kRideSpeed, std::sqrt(way * kRideAcceleration));
  return kRideWait + (speed > 0 ? way / speed + speed / kRideAcceleration : 0);
}

double ride_end(double rise_m) { return ride_arrival(rise_m) + kRideWait; }

/// Where the next ride is on the route, which goes round; infinite without one.
double RideControl::next_ride(const Route& route, double s) const {
  double next = std::numeric_limits<double>::infinity();
  for (const Route::Lift& lift : route.lifts()) {
    double there = lift.s + std::floor((s - lift.s) / route.length()) * route.length();
    while (there < s - 2 * kStopSlack || there <= done_until_) there += route.length();
    next = std::min(next, there);
  }
  return next;
}

double RideControl::speed_limit(const Route& route, double s, double acceleration) const {
  if (riding_) return 0;
  const double left = next_ride(route, s) - s;
  return left < kStopSlack ? 0 : std::sqrt(2 * acceleration * left);
}

void RideControl::watch(TimeNs t, const Route& route, double s, double speed) {
  if (riding_) {
    riding_ = to_seconds(t - rides_.back().begin) < ride_end(rides_.back().rise_m);
    if (!riding_) before_ += rides_.back().rise_m;
    return;
  }
  const double there = next_ride(route, s);
  if (speed != 0 || there - s >= kStopSlack) return;
  const Route::Place place = route.at(s);
  const double rise_m = route.lifted(s, there + kStopSlack);
  rides_.push_back({t, place.position, place.heading, rise_m});
  riding_ = true;
  done_until_ = there + kStopSlack;
}

void RideControl::leave(TimeNs t) {
  before_ = height(t);
  riding_ = false;
  done_until_ = -1e9;
}

double RideControl::height(TimeNs t) const {
  if (!riding_) return before_;
  return before_ + ride_height(rides_.back().rise_m, to_seconds(t - rides_.back().begin));
}

}  // namespace holdfast::simulation
