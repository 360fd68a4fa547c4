#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "simulation/motion/route.hpp"
#include "simulation/motion/speed_limit.hpp"
#include "simulation/motion/trajectory.hpp"

namespace holdfast::simulation {

/// Someone or something for a vehicle to keep away from: where its axis is at each tick, and how
/// far from the vehicle's outline that must stay, in metres.
struct Obstacle {
  std::vector<Eigen::Vector3d> path;
  double clearance;
};

/// Drives one vehicle round its route, a decision every quarter of a second: on, if it could then
/// still stop in time or get away; else to brake; else backwards.
class VehicleDrive {
 public:
  /// `size`: length and width. The obstacles are used later and must outlive this.
  VehicleDrive(const Route& route, double speed_m_s, const Eigen::Vector2d& size,
               const std::vector<Obstacle>& obstacles);

  /// The drive from `s` on the route; none when something came too near all the same.
  std::optional<Trajectory> from(double s) const;

  /// How many ticks an obstacle's path must have for a log of that length, and their times.
  static std::size_t ticks(TimeNs duration);
  static TimeNs tick_time(std::size_t tick);

 private:
  struct State {
    double s = 0;
    double speed = 0;
  };
  enum class Manoeuvre { kStop, kGo, kBack };

  State after(const State& state, Manoeuvre manoeuvre, double seconds) const;
  double room(std::size_t tick, double s) const;
  double seconds_clear(std::size_t tick, State state, Manoeuvre first, Manoeuvre then) const;
  Manoeuvre choose(std::size_t tick, const State& state) const;
  bool is_clear(const Trajectory& path) const;

  const Route& route_;
  SpeedLimit limit_;
  Eigen::Vector2d size_;
  const std::vector<Obstacle>& obstacles_;
  std::size_t ticks_;
};

}  // namespace holdfast::simulation
