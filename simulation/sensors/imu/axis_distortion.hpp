#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "simulation/sensors/imu/imu_faults.hpp"

namespace holdfast::simulation {

/// How three axes of an IMU, gyro or accelerometer, turn what they feel into a reading.
class AxisDistortion {
 public:
  /// Scales and misalignments are drawn from the streams `sensor`_scale and `sensor`_misalignment.
  static AxisDistortion of_gyro(const ImuFaults& faults, std::uint64_t seed);
  static AxisDistortion of_accelerometer(const ImuFaults& faults, std::uint64_t seed);

  /// 1 + scale errors on the diagonal, beside it the share of the other axes.
  const Eigen::Matrix3d& matrix() const { return matrix_; }

  /// What the axes make of the true value, before biases and noise.
  Eigen::Vector3d distort(const Eigen::Vector3d& felt) const;

  /// The number that comes out: rounded to the resolution, then within the full scale.
  Eigen::Vector3d read(const Eigen::Vector3d& value) const;

 private:
  struct Sizes {
    double scale_sigma, misalignment_rad, full_scale, resolution;
  };
  AxisDistortion(const Sizes& sizes, std::uint64_t seed, const std::string& sensor);

  Eigen::Matrix3d matrix_;
  bool distorts_;
  double full_scale_;
  double resolution_;
};

}  // namespace holdfast::simulation
