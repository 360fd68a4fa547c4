#pragma once

#include <cstddef>
#include <numbers>

#include "holdfast/core/time.hpp"
#include "simulation/motion/smoothing.hpp"

/// The ticks in which DrivePlanner plans: knots of the splines.
namespace holdfast::simulation {

inline constexpr double kTwoPi = 2 * std::numbers::pi;
inline constexpr TimeNs kKnot = kSecond / 20;
inline constexpr double kKnotSeconds = 0.05;

/// Smoothing and spline spread each tick to both sides; the robot therefore sets off this much
/// after its rest ends.
inline constexpr std::size_t kSplineReach = 3;
inline constexpr TimeNs kReach = TimeNs{kMeanReach + kSplineReach} * kKnot;

/// A leg's controls begin before its start by these many ticks, so that two legs can be joined; the
/// first tick of all lies as many before the log.
inline constexpr std::size_t kLead = 20;

inline TimeNs tick_time(std::size_t tick) {
  return (static_cast<TimeNs>(tick) - TimeNs{kLead}) * kKnot;
}
inline std::size_t tick_at(TimeNs t) { return static_cast<std::size_t>(t / kKnot) + kLead; }

}  // namespace holdfast::simulation
