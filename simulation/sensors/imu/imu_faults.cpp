#include "simulation/sensors/imu/imu_faults.hpp"

#include <numbers>
#include <vector>

namespace holdfast::simulation {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kStandardGravity = 9.80665;
constexpr double kHalfRange = 32768;  // of 16 bits

}  // namespace

ImuFaults ImuFaults::usual() {
  ImuFaults faults;
  faults.gyro_bias_instability = 2 * kDegree / 3600;
  faults.accel_bias_instability = 0.03e-3 * kStandardGravity;
  faults.gyro_scale_sigma = 0.01 / 3;
  faults.accel_scale_sigma = 0.005 / 3;
  faults.gyro_misalignment_rad = 0.01 / 3;
  faults.accel_misalignment_rad = 0.005 / 3;
  faults.gyro_full_scale_rad_s = 500 * kDegree;
  faults.accel_full_scale_m_s2 = 6 * kStandardGravity;
  faults.gyro_resolution_rad_s = faults.gyro_full_scale_rad_s / kHalfRange;
  faults.accel_resolution_m_s2 = faults.accel_full_scale_m_s2 / kHalfRange;
  faults.gyro_vibration_rad_s = 0.01;
  faults.accel_vibration_m_s2 = 0.5;
  faults.low_pass_hz = 64;
  return faults;
}

// vibration_cycles_per_m is never off: it stays unless the vibration itself comes from `others`.
ImuFaults ImuFaults::completed_by(const ImuFaults& others) const {
  ImuFaults out = *this;
  std::vector<const double*> theirs;
  const auto list = [&](const char*, const double& value, const FieldDoc&) {
    theirs.push_back(&value);
  };
  fields(others, list);
  std::size_t at = 0;
  const auto fill = [&](const char*, double& value, const FieldDoc&) {
    const double other = *theirs[at++];
    if (value == 0) value = other;
  };
  fields(out, fill);
  const bool shook = gyro_vibration_rad_s > 0 || accel_vibration_m_s2 > 0;
  if (!shook) out.vibration_cycles_per_m = others.vibration_cycles_per_m;
  return out;
}

}  // namespace holdfast::simulation
