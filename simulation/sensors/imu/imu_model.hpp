#pragma once

#include <Eigen/Core>

namespace holdfast::simulation {

/// An IMU as the article simulates it (4.1.1), with biases that start somewhere and walk.
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

  /// The same sensor without noise and without biases, for tests.
  static ImuModel perfect() {
    ImuModel model;
    model.gyro_noise_density = model.accel_noise_density = 0;
    model.gyro_bias_walk = model.accel_bias_walk = 0;
    model.gyro_bias_initial = model.accel_bias_initial = 0;
    return model;
  }
};

}  // namespace holdfast::simulation
