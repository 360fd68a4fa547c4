#pragma once

#include <cmath>

#include "tests/tolerances.hpp"

/// Tolerances of the simulator's tests, each derived.
namespace holdfast::tolerances {

/// A point cast in a room of up to 16 m: origin, direction (unit length times range) and range are
/// floats (relative error 6e-8 each), as is the stored point: four roundings of up to 16 m * 6e-8;
/// Embree's robust intersection adds a few of the same size. Within a column the pose is continued
/// to first order: 1e-8.
constexpr double kRayInRoom = 12 * 16 * 6e-8;

/// Largest |d^4/dt^4| of body rates in the test drives: sway of 3 mrad at up to 2.5 Hz (two waves
/// of half the amplitude), turns of 1 rad/s that set in over 0.35 s, and a wobble of so many
/// radians at up to 3 Hz.
inline double fourth_of_rates(double wobble) {
  return 0.003 * std::pow(2 * M_PI * 2.5, 5) + 1 / std::pow(0.35, 4) +
         wobble * std::pow(2 * M_PI * 3, 5);
}

/// Attitude error of the fourth-order Magnus integration over `t` seconds with steps of `step` (two
/// IMU intervals): Simpson's rule leaves step^4 / 2880 of the fourth derivative a second.
inline double integrated_attitude(double t, double step, double wobble = 0) {
  return t * std::pow(step, 4) / 2880 * fourth_of_rates(wobble);
}

/// Position error that follows: gravity is turned by an attitude error that grows linearly. The
/// accelerations themselves are cubic between the spline's knots, which Simpson's rule integrates
/// exactly.
inline double integrated_position(double t, double step, double wobble = 0) {
  return 9.81 * integrated_attitude(t, step, wobble) * t * t / 6;
}

/// How far the variance of `n` independent normal values may lie from the true one, relative to it:
/// 5 standard deviations of a chi-square distribution divided by n.
inline double variance_error(double n) { return 5 * std::sqrt(2.0 / n); }

/// How far an Allan variance from `n` differences of neighbouring clusters may lie from the true
/// one, relative to it. Neighbouring differences are correlated by -1/2 (white noise) to 1/4 (a
/// walk), their squares by at most 1/4 on either side: as good as n / 1.5 independent ones.
inline double allan_variance(double n) { return variance_error(n / 1.5); }

/// What a sum over the `n` samples of a cluster leaves out of its integral, relative to the
/// variance: an end of half a sample on either side.
inline double allan_sampling(double n) { return 1 / n; }

/// How far a count of independent events may lie from its mean, the sum of their probabilities p:
/// 5 standard deviations, for `variance` the sum of p (1 - p); one event more, as counts are whole.
inline double count_error(double variance) { return 5 * std::sqrt(variance) + 1; }

}  // namespace holdfast::tolerances
