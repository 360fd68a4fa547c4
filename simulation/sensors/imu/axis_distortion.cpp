#include "simulation/sensors/imu/axis_distortion.hpp"

#include "simulation/sensors/imu/normal_vector.hpp"

namespace holdfast::simulation {

using Eigen::Matrix3d;
using Eigen::Vector3d;

AxisDistortion AxisDistortion::of_gyro(const ImuFaults& faults, std::uint64_t seed) {
  return {{faults.gyro_scale_sigma, faults.gyro_misalignment_rad, faults.gyro_full_scale_rad_s,
           faults.gyro_resolution_rad_s},
          seed,
          "imu.gyro"};
}

AxisDistortion AxisDistortion::of_accelerometer(const ImuFaults& faults, std::uint64_t seed) {
  return {{faults.accel_scale_sigma, faults.accel_misalignment_rad, faults.accel_full_scale_m_s2,
           faults.accel_resolution_m_s2},
          seed,
          "imu.accel"};
}

AxisDistortion::AxisDistortion(const Sizes& sizes, std::uint64_t seed, const std::string& sensor)
    : matrix_(Matrix3d::Identity()),
      distorts_(sizes.scale_sigma > 0 || sizes.misalignment_rad > 0),
      full_scale_(sizes.full_scale),
      resolution_(sizes.resolution) {
  RandomStream scale(seed, sensor + "_scale");
  RandomStream misalignment(seed, sensor + "_misalignment");
  matrix_.diagonal() += sizes.scale_sigma * normal_vector(scale);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      if (row != column) matrix_(row, column) = sizes.misalignment_rad * misalignment.normal();
    }
  }
}

Vector3d AxisDistortion::distort(const Vector3d& felt) const {
  return distorts_ ? Vector3d(matrix_ * felt) : felt;
}

Vector3d AxisDistortion::read(const Vector3d& value) const {
  Vector3d out = value;
  if (resolution_ > 0) out = resolution_ * (out / resolution_).array().round().matrix();
  if (full_scale_ > 0) out = out.cwiseMax(-full_scale_).cwiseMin(full_scale_);
  return out;
}

}  // namespace holdfast::simulation
