#pragma once

#include <Eigen/Core>

#include "holdfast/core/fields.hpp"
#include "holdfast/core/se3.hpp"
#include "holdfast/preprocess/imu_buffer.hpp"

namespace holdfast::filter {

/// Noise of the IMU as continuous-time densities. The defaults are ten times those of the article
/// (3.1.1): they stand for an unknown IMU on a vehicle, with vibration, scale and timing errors
/// that a data sheet's white noise leaves out.
struct ImuNoiseConfig {
  double gyro_noise_density = 1.7e-3;
  double accel_noise_density = 2.0e-2;
  double gyro_bias_walk = 2.0e-5;
  double accel_bias_walk = 2.0e-4;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("gyro_noise_density", self.gyro_noise_density,
          FieldDoc{"white noise of the gyroscope, rad/s/sqrt(Hz)", 1e-8, 1.0});
    visit("accel_noise_density", self.accel_noise_density,
          FieldDoc{"white noise of the accelerometer, m/s^2/sqrt(Hz)", 1e-8, 10.0});
    visit("gyro_bias_walk", self.gyro_bias_walk,
          FieldDoc{"random walk of the gyroscope's bias, rad/s^2/sqrt(Hz)", 0.0, 1.0});
    visit("accel_bias_walk", self.accel_bias_walk,
          FieldDoc{"random walk of the accelerometer's bias, m/s^3/sqrt(Hz)", 0.0, 10.0});
  }
};

using Matrix15d = Eigen::Matrix<double, 15, 15>;
using Vector15d = Eigen::Matrix<double, 15, 1>;

/// State and error covariance at a time. Errors in the order [position, rotation, velocity,
/// accelerometer bias, gyroscope bias]: position and velocity add in the map frame, rotation is
/// perturbed on the right.
struct FilterState {
  enum Offset : int { kP = 0, kR = 3, kV = 6, kBa = 9, kBg = 12 };

  TimeNs t = 0;
  SE3 T_map_body;
  Eigen::Vector3d v_map = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
  Matrix15d P = Matrix15d::Identity();

  /// Estimates of both biases with their joint covariance.
  struct Biases {
    Eigen::Vector3d accel = Eigen::Vector3d::Zero();
    Eigen::Vector3d gyro = Eigen::Vector3d::Zero();
    Eigen::Matrix<double, 6, 6> P = Eigen::Matrix<double, 6, 6>::Identity();
  };
  Biases biases() const { return {accel_bias, gyro_bias, P.bottomRightCorner<6, 6>()}; }
  /// Replaces the estimate of the biases, independently of the rest of the state.
  void set_biases(const Biases& biases);

  /// x + error.
  void add(const Vector15d& error);
  /// Error e with other + e = *this.
  Vector15d minus(const FilterState& other) const;
};

/// Longest time without measurements over which a held reading is taken for what the robot does.
constexpr TimeNs kLongestHold = kSecond / 20;

/// Carries state and covariance through the readings of `imu`, which begin at state.t: the model of
/// article 3.1.1 (a = R (a~ - b_a) + g) with the midpoint rule, the covariance to first order.
/// `gravity` in the map frame.
/// Where readings are held, what the robot does wanders away from them: over more than kLongestHold
/// the difference is kept in the biases, so that scans can tell what the robot does.
void propagate(FilterState& state, const preprocess::ImuSegment& imu,
               const Eigen::Vector3d& gravity, const ImuNoiseConfig& noise);

}  // namespace holdfast::filter
