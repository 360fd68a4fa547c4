#include "simulation/sensors/imu/vibration.hpp"

#include <cmath>
#include <numbers>

#include "holdfast/core/random.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2 * std::numbers::pi;

Vector3d phases(RandomStream& random) {
  const double x = random.uniform(0, kTurn);
  const double y = random.uniform(0, kTurn);
  return {x, y, random.uniform(0, kTurn)};
}

/// Phase of the Butterworth filter 1 / (1 + sqrt(2) s + s^2) at s = i f / f_edge.
double lag_rad(double frequency_hz, double low_pass_hz) {
  if (low_pass_hz == 0) return 0;
  const double x = frequency_hz / low_pass_hz;
  return std::atan2(std::numbers::sqrt2 * x, 1 - x * x);
}

}  // namespace

Vibration::Vibration(const ImuFaults& faults, double interval_s, std::uint64_t seed)
    : faults_(faults), interval_s_(interval_s) {
  RandomStream random(seed, "imu.vibration");
  for (int k = 0; k < kHarmonics; ++k) {
    gyro_phases_rad_[static_cast<std::size_t>(k)] = phases(random);
    accel_phases_rad_[static_cast<std::size_t>(k)] = phases(random);
  }
}

double Vibration::gain(double frequency_hz, double low_pass_hz) {
  if (low_pass_hz == 0) return 1;
  return 1 / std::sqrt(1 + std::pow(frequency_hz / low_pass_hz, 4));
}

Vibration::Shaking Vibration::next(double speed_m_s) {
  Shaking shaking;
  if (faults_.gyro_vibration_rad_s == 0 && faults_.accel_vibration_m_s2 == 0) return shaking;
  const double way_m = interval_s_ * (last_speed_m_s_ + speed_m_s) / 2;
  last_speed_m_s_ = speed_m_s;
  cycles_ += faults_.vibration_cycles_per_m * way_m;
  for (std::size_t k = 0; k < kHarmonics; ++k) {
    const auto number = static_cast<double>(k + 1);
    const double frequency_hz = number * faults_.vibration_cycles_per_m * speed_m_s;
    const double size = speed_m_s / number * gain(frequency_hz, faults_.low_pass_hz);
    const double phase = kTurn * number * cycles_ - lag_rad(frequency_hz, faults_.low_pass_hz);
    shaking.gyro_rad_s +=
        size * faults_.gyro_vibration_rad_s * (gyro_phases_rad_[k].array() + phase).sin().matrix();
    shaking.accel_m_s2 +=
        size * faults_.accel_vibration_m_s2 * (accel_phases_rad_[k].array() + phase).sin().matrix();
  }
  return shaking;
}

}  // namespace holdfast::simulation
