#pragma once

#include <Eigen/Core>

#include "holdfast/core/fields.hpp"
#include "simulation/sensors/imu/imu_faults.hpp"

namespace holdfast::simulation {

/// An IMU as the article simulates it (4.1.1), with biases that start somewhere and walk, and
/// without any other fault unless `faults` says so.
struct ImuModel {
  double rate_hz = 200.0;                    ///< must divide 1e9 ns
  double gyro_noise_density = 1e-4;          ///< rad/s/sqrt(Hz)
  double accel_noise_density = 3e-3;         ///< m/s^2/sqrt(Hz)
  double gyro_bias_walk = 1e-5;              ///< rad/s^2/sqrt(Hz)
  double accel_bias_walk = 1e-4;             ///< m/s^3/sqrt(Hz)
  double gyro_bias_initial = 0.003;          ///< rad/s, sigma of each axis at the start of the log
  double accel_bias_initial = 0.03;          ///< m/s^2, sigma of each axis at the start of the log
  double gyro_bias_jump = 0.03;              ///< rad/s, size of an imu_bias_jump
  double accel_bias_jump = 0.3;              ///< m/s^2, size of an imu_bias_jump
  Eigen::Vector3d gravity_map{0, 0, -9.81};  ///< m/s^2, acceleration of free fall
  ImuFaults faults;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("rate_hz", self.rate_hz, FieldDoc{"samples; must divide a second into whole ns", 1, 1e4});
    visit("gyro_noise_density", self.gyro_noise_density, FieldDoc{"rad/s/sqrt(Hz)", 0, 1});
    visit("accel_noise_density", self.accel_noise_density, FieldDoc{"m/s^2/sqrt(Hz)", 0, 10});
    visit("gyro_bias_walk", self.gyro_bias_walk, FieldDoc{"rad/s^2/sqrt(Hz)", 0, 1});
    visit("accel_bias_walk", self.accel_bias_walk, FieldDoc{"m/s^3/sqrt(Hz)", 0, 10});
    visit("gyro_bias_initial", self.gyro_bias_initial,
          FieldDoc{"rad/s, sigma of each axis at the start of the log", 0, 1});
    visit("accel_bias_initial", self.accel_bias_initial,
          FieldDoc{"m/s^2, sigma of each axis at the start of the log", 0, 10});
    visit("gyro_bias_jump", self.gyro_bias_jump,
          FieldDoc{"rad/s, size of an imu_bias_jump", 0, 10});
    visit("accel_bias_jump", self.accel_bias_jump,
          FieldDoc{"m/s^2, size of an imu_bias_jump", 0, 100});
    ImuFaults::fields(self.faults, visit);
  }

  /// The same sensor without noise and without biases, for tests.
  static ImuModel perfect() {
    ImuModel model;
    model.gyro_noise_density = model.accel_noise_density = 0;
    model.gyro_bias_walk = model.accel_bias_walk = 0;
    model.gyro_bias_initial = model.accel_bias_initial = 0;
    return model;
  }

  /// The same sensor with the faults that are usual in its class (ImuFaults::usual()) where it has
  /// none of its own.
  ImuModel with_usual_faults() const {
    ImuModel model = *this;
    model.faults = faults.completed_by(ImuFaults::usual());
    return model;
  }
};

}  // namespace holdfast::simulation
