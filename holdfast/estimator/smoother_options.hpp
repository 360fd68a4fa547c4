#pragma once

#include "holdfast/estimator/preintegration.hpp"

namespace holdfast::estimator {

/// The window and what may change within it.
struct SmootherConfig {
  int window = 10;
  double gravity_walk = 1e-4;
  double accel_jump_m_s2 = 0.5;
  double gyro_jump_rad_s = 0.05;
  double imu_weight = 0;
  Preintegration::Noise noise;  ///< has field lists of its own

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("window", self.window, FieldDoc{"nodes that are estimated together", 3, 1000});
    visit("gravity_walk", self.gravity_walk,
          FieldDoc{"random walk of gravity in the map frame, m/s^2/sqrt(s)", 0.0, 1.0});
    visit("accel_jump_m_s2", self.accel_jump_m_s2,
          FieldDoc{"standard deviation of a jump of the accelerometer's bias", 0.0, 100.0});
    visit("gyro_jump_rad_s", self.gyro_jump_rad_s,
          FieldDoc{"standard deviation of a jump of the gyroscope's bias", 0.0, 10.0});
    visit("imu_weight", self.imu_weight,
          FieldDoc{"weight on the squared norm of the IMU's residual instead of its covariance "
                   "(article 3.3.2: 1.2); 0: its covariance",
                   0.0, 1e6});
  }
};

/// When an optimisation is done.
struct OptimiseOptions {
  int max_measurements = 4;    ///< how often the newest node's map residual is linearised at most
  int min_measurements = 1;    ///< and at least, where a robust loss narrows from call to call
  int max_linearisations = 3;  ///< of the other nodes
  double converged_m = 1e-4;   ///< change of the newest node below which another step is idle
  double converged_rad = 1e-5;
  /// Turn of any node beyond which the chain is linearised again: its residuals are linear in all
  /// but rotations, and change by g dt / 2 times the square of this.
  double relinearise_rad = 1e-3;
};

/// What an optimisation did.
struct OptimiseReport {
  bool solved = false;     ///< false: the system was not positive definite, so reset() is needed
  bool converged = false;  ///< the last step was below the limits
  bool map_used = false;   ///< the newest node has a map residual
  int measurements = 0;
  int linearisations = 0;
  double cost = 0;                           ///< of all factors at the last linearised optimum
  Vector18d correction = Vector18d::Zero();  ///< newest node minus its prediction
};

}  // namespace holdfast::estimator
