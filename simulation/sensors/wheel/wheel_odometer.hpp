#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "holdfast/core/sensor_data.hpp"
#include "simulation/events/time_span.hpp"
#include "simulation/motion/drive.hpp"

namespace holdfast::simulation {

/// Two driven wheels left and right of the body's origin, and what they do wrong. Chosen, without a
/// source: encoders, slip and tolerances of an ordinary robot on hard floors.
struct WheelModel {
  double rate_hz = 50;
  double track_m = 0.5;         ///< between the wheels
  double ticks_per_m = 2000;    ///< of each wheel; whole ticks are counted
  double scale_sigma = 0.003;   ///< of each wheel's radius, as a share; drawn once a seed
  double turn_slip = 0.05;      ///< in turns wheels turn so much further apart than the ground
  double slips_per_minute = 4;  ///< spans in which one wheel, left or right by chance, spins
  double slip_mean_s = 0.5;     ///< their length
  double slip_share = 0.3;      ///< how much further it turns meanwhile
};

/// Counts ticks over equal intervals and makes speed and yaw rate of them. Sums them up to a pose
/// in a plane as well, as robots do.
class WheelOdometer {
 public:
  /// Over a log of this length. Streams: "wheel.scale", "wheel.slip", "wheel.slip_side".
  WheelOdometer(const WheelModel& model, std::uint64_t seed, TimeNs length);

  /// A stretch over which a wheel turns further than the ground goes.
  struct Slip {
    TimeSpan span;
    int wheel = 0;  ///< 0 left, 1 right
  };
  const std::vector<Slip>& slips() const { return slips_; }
  const std::array<double, 2>& scales() const { return scales_; }  ///< left, right; 1 is right

  /// One sample an interval of `drive`; times from the start of the log.
  std::vector<WheelSample> samples(const Drive& drive) const;

 private:
  /// How far each wheel turns, in metres, per second.
  std::array<double, 2> wheel_speeds(const MotionState& motion, TimeNs t) const;

  WheelModel model_;
  TimeNs length_;
  std::array<double, 2> scales_;
  std::vector<Slip> slips_;
};

}  // namespace holdfast::simulation
