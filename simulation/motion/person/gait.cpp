#include "simulation/motion/person/gait.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "holdfast/core/random.hpp"
#include "simulation/motion/smoothing.hpp"

namespace holdfast::simulation {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kEvery = 4;  // seconds: one gesture each
constexpr std::uint64_t kAxes = 3;

}  // namespace

Gait::Gait(const DriveStyle& style, std::uint64_t seed)
    : heave_m_(style.step_heave_m),
      sway_m_(style.step_sway_m),
      gesture_rad_(style.gesture_rad),
      gesture_rad_s_(style.gesture_rad_s),
      seed_(seed) {
  RandomStream random(seed, "drive.steps");
  steps_hz_ = random.uniform(1.8, 2.2);
  phase_ = random.uniform(0, kTwoPi);
}

void Gait::add(double t, double moving, PoseVector& control) const {
  const double step = kTwoPi * steps_hz_ * t + phase_;
  const double sway = moving * sway_m_ * std::sin(0.5 * step);
  control[0] -= sway * std::sin(control[3]);
  control[1] += sway * std::cos(control[3]);
  control[2] += moving * heave_m_ * std::sin(step);
  if (gesture_rad_ == 0 || t < 0) return;
  const auto index = static_cast<std::uint64_t>(t / kEvery);
  const auto axis = static_cast<Eigen::Index>(index % kAxes);
  control[3 + axis] += moving * gesture(index, t - kEvery * static_cast<double>(index));
}

/// There and back within kEvery, at rest in between; nods and tilts go half as far as turns.
double Gait::gesture(std::uint64_t index, double since) const {
  RandomStream random(seed_, "drive.gesture." + std::to_string(index));
  const double size = (index % kAxes == 0 ? 1 : 0.5) * gesture_rad_ * random.uniform(0.7, 1);
  const double rate = gesture_rad_s_ * random.uniform(0.5, 1);
  const double turning_s = std::min(kSmoothStepSteepest * size / rate, 0.4 * kEvery);
  const double held_s = random.uniform(0, 0.5) * (kEvery - 2 * turning_s);
  const double begin = random.uniform() * (kEvery - 2 * turning_s - held_s);
  const double sign = random.below(2) == 0 ? 1 : -1;
  const double there = smooth_step((since - begin) / turning_s);
  const double back = smooth_step((since - begin - turning_s - held_s) / turning_s);
  return sign * size * (there - back);
}

}  // namespace holdfast::simulation
