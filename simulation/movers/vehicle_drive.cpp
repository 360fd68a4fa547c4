#include "simulation/movers/vehicle_drive.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "simulation/motion/smoothing.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

constexpr TimeNs kTick = kSecond / 20;
constexpr double kTickSeconds = 0.05;
constexpr std::size_t kMargin = kMeanReach + 6;  // ticks that smoothing and spline need at each end
constexpr std::size_t kDecision = 5;             // ticks from one decision to the next
constexpr double kDecisionSeconds = kDecision * kTickSeconds;
constexpr int kLookAhead = 32;  // decisions: eight seconds

constexpr double kGain = 1.5;       // m/s^2
constexpr double kBrake = 3.0;      // m/s^2
constexpr double kBackSpeed = 1.5;  // m/s
constexpr double kSpare = 0.25;     // metres of room beyond what is asked for, for the smoothing
constexpr double kStorey = 2.2;     // metres up or down: another level of a car park

DriveStyle style_of(double speed_m_s) {
  DriveStyle style;
  style.speed_m_s = speed_m_s;
  style.acceleration_m_s2 = kGain;
  style.yaw_rate_rad_s = 0.8;
  style.lateral_m_s2 = 2.0;
  return style;
}

/// Metres from the outline of a vehicle to a point beside or within it (then below 0).
double distance_to(const Vector3d& position, double heading, const Eigen::Vector2d& size,
                   const Vector3d& p) {
  const Vector3d way = p - position;
  if (std::abs(way.z()) > kStorey) return std::numeric_limits<double>::infinity();
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  const Eigen::Vector2d beside(std::abs(c * way.x() + s * way.y()) - 0.5 * size.x(),
                               std::abs(c * way.y() - s * way.x()) - 0.5 * size.y());
  const double within = std::min(0.0, beside.maxCoeff());
  return beside.cwiseMax(0).norm() + within;
}

}  // namespace

VehicleDrive::VehicleDrive(const Route& route, double speed_m_s, const Eigen::Vector2d& size,
                           const std::vector<Obstacle>& obstacles)
    : route_(route),
      limit_(route, style_of(speed_m_s)),
      size_(size),
      obstacles_(obstacles),
      ticks_(obstacles.front().path.size()) {}

std::size_t VehicleDrive::ticks(TimeNs duration) {
  return static_cast<std::size_t>(duration / kTick) + 2 * kMargin + 2;
}

TimeNs VehicleDrive::tick_time(std::size_t tick) {
  return (static_cast<TimeNs>(tick) - static_cast<TimeNs>(kMargin)) * kTick;
}

VehicleDrive::State VehicleDrive::after(const State& state, Manoeuvre manoeuvre,
                                        double seconds) const {
  double target = 0;
  if (manoeuvre == Manoeuvre::kGo) target = limit_.at(state.s);
  if (manoeuvre == Manoeuvre::kBack) target = -kBackSpeed;
  const double speed =
      state.speed + std::clamp(target - state.speed, -kBrake * seconds, kGain * seconds);
  return {state.s + 0.5 * (state.speed + speed) * seconds, speed};
}

/// Metres that the vehicle has left at `s`, beyond what its obstacles ask for.
double VehicleDrive::room(std::size_t tick, double s) const {
  const Route::Place place = route_.at(s);
  double least = std::numeric_limits<double>::infinity();
  for (const Obstacle& obstacle : obstacles_) {
    const Vector3d& p = obstacle.path[std::min(tick, ticks_ - 1)];
    const double away = (p - place.position).head<2>().norm() - 0.5 * (size_.x() + size_.y());
    if (away - obstacle.clearance > least) continue;
    least =
        std::min(least, distance_to(place.position, place.heading, size_, p) - obstacle.clearance);
  }
  return least;
}

/// How long nothing comes too near when the vehicle does `first` until the next decision, and
/// `then` from there on.
double VehicleDrive::seconds_clear(std::size_t tick, State state, Manoeuvre first,
                                   Manoeuvre then) const {
  for (int ahead = 1; ahead <= kLookAhead; ++ahead) {
    state = after(state, ahead == 1 ? first : then, kDecisionSeconds);
    const std::size_t at = tick + static_cast<std::size_t>(ahead) * kDecision;
    if (room(at, state.s) < kSpare) return (ahead - 1) * kDecisionSeconds;
  }
  return std::numeric_limits<double>::infinity();
}

VehicleDrive::Manoeuvre VehicleDrive::choose(std::size_t tick, const State& state) const {
  using enum Manoeuvre;
  static constexpr std::array kInOrder = {std::pair(kGo, kStop), std::pair(kGo, kGo),
                                          std::pair(kStop, kStop), std::pair(kBack, kBack)};
  Manoeuvre best = kGo;
  double longest = -1;
  for (const auto& [first, then] : kInOrder) {
    const double clear = seconds_clear(tick, state, first, then);
    if (clear <= longest) continue;
    longest = clear;
    best = first;
    if (std::isinf(clear)) break;
  }
  return best;
}

std::optional<Trajectory> VehicleDrive::from(double s) const {
  if (room(0, s) < kSpare) return {};
  State state{s, 0};
  Manoeuvre manoeuvre = Manoeuvre::kGo;
  std::vector<PoseVector> places;
  for (std::size_t tick = 0; tick < ticks_; ++tick) {
    const Route::Place place = route_.at(state.s);
    PoseVector pose;
    pose << place.position, place.heading, -std::atan(place.slope), 0;
    places.push_back(pose);
    if (tick % kDecision == 0) {
      if (room(tick, state.s) < 0) return {};
      manoeuvre = choose(tick, state);
    }
    state = after(state, manoeuvre, kTickSeconds);
  }
  Trajectory path(tick_time(kMeanReach), kTick, smoothed(std::move(places)));
  if (!is_clear(path)) return {};
  return path;
}

/// What was driven, not what was planned.
bool VehicleDrive::is_clear(const Trajectory& path) const {
  for (std::size_t tick = kMargin; tick + kMargin < ticks_; ++tick) {
    const auto pose = path.values_at(tick_time(tick)).pose;
    for (const Obstacle& obstacle : obstacles_) {
      const double there = distance_to(pose.head<3>(), pose[3], size_, obstacle.path[tick]);
      if (there < obstacle.clearance) return false;
    }
  }
  return true;
}

}  // namespace holdfast::simulation
