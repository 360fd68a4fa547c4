#pragma once

#include "holdfast/core/fields.hpp"
#include "holdfast/estimator/node_state.hpp"
#include "holdfast/filter/filter_state.hpp"
#include "holdfast/preprocess/imu_buffer.hpp"

namespace holdfast::estimator {

/// What is known of the motion where no reading tells it: each axis of specific force and rate
/// leaves the held reading as an Ornstein-Uhlenbeck process, that is like a random walk at first
/// and never further than the sigmas given. Its integral over an age t of the reading has the
/// variance
///   V(t) = sigma^2 tau^2 (2 t / tau - 3 + 4 exp(-t / tau) - exp(-2 t / tau)),
/// and the noise of a held interval is what V grows by over it. Between two readings far apart the
/// process is tied down at both ends: 2 V(gap / 2). Young readings wander as in filter::propagate;
/// there is no account of the age at which a reading enters a segment: over long holds the bias of
/// the nodes carries it (FixedLagSmoother::push).
struct UnmeasuredMotion {
  double accel_sigma_m_s2 = 1.5;
  double gyro_sigma_rad_s = 0.5;
  double time_constant_s = 0.5;
  double longest_interval_s = 0.025;  ///< readings further apart than this leave a gap

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit(
        "accel_sigma_m_s2", self.accel_sigma_m_s2,
        FieldDoc{"how far the acceleration wanders while no reading tells it, m/s^2", 0.0, 100.0});
    visit("gyro_sigma_rad_s", self.gyro_sigma_rad_s,
          FieldDoc{"how far the rate wanders while no reading tells it, rad/s", 0.0, 100.0});
    visit("time_constant_s", self.time_constant_s,
          FieldDoc{"after what time it has wandered as far as it does, s", 1e-3, 100.0});
    visit("longest_interval_s", self.longest_interval_s,
          FieldDoc{"readings further apart than this leave a gap, s", 1e-4, 10.0});
  }
};

/// Motion from node i to node j as the IMU tells it, without gravity and the velocity of i, in the
/// body frame at i (Forster et al., TRO 2017, eq. 33).
struct MotionIncrement {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
};

/// On-manifold preintegration of the readings between two nodes (Forster et al., TRO 2017) with the
/// midpoint rule of filter::propagate: increments, their 9x9 covariance and their derivatives by
/// the biases, all in the order [position, rotation (on the right), velocity]. The increments
/// printed in the article (3.1.1) depend on the world frame and are no preintegration;
/// docs/paper_map.md.
class Preintegration {
 public:
  using BiasJacobian = Eigen::Matrix<double, 9, 6>;  ///< columns [accelerometer, gyroscope]

  struct Noise {
    filter::ImuNoiseConfig imu;
    UnmeasuredMotion unmeasured;
  };

  /// Integrates `imu` with the given biases. Keeps the readings, so that biases can move later; no
  /// allocation once the buffers have grown.
  void integrate(const preprocess::ImuSegment& imu, const Eigen::Vector3d& accel_bias,
                 const Eigen::Vector3d& gyro_bias, const Noise& noise);

  /// Integrates once more if the gyroscope's bias is so far from that of the last integration that
  /// it turns the increment by more than kLargestTurn. The increments are linear in the
  /// accelerometer's bias. Returns whether it did.
  bool rebase(const Eigen::Vector3d& accel_bias, const Eigen::Vector3d& gyro_bias);

  /// The error of the first-order correction is half of its square: 5e-7 rad, and g dt times that.
  static constexpr double kLargestTurn = 1e-3;

  /// Increments at other biases, to first order (Forster eq. 44).
  MotionIncrement corrected(const Eigen::Vector3d& accel_bias,
                            const Eigen::Vector3d& gyro_bias) const;

  /// The state at the end when it was `from` at the beginning; biases and gravity stay.
  NodeState predict(const NodeState& from) const;

  TimeNs end() const { return end_; }
  double seconds() const { return seconds_; }
  const MotionIncrement& increment() const { return increment_; }
  const Matrix9d& covariance() const { return covariance_; }
  const BiasJacobian& bias_jacobian() const { return bias_jacobian_; }
  const Eigen::Vector3d& accel_bias() const { return accel_bias_; }
  const Eigen::Vector3d& gyro_bias() const { return gyro_bias_; }

 private:
  void run();
  void step(const ImuSample& a, const ImuSample& b, double dt, double accel_variance,
            double gyro_variance);
  double wandered(const ImuSample& a, const ImuSample& b) const;

  preprocess::ImuSegment imu_;
  Noise noise_;
  TimeNs end_ = 0;
  double seconds_ = 0;
  Eigen::Vector3d accel_bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero();
  MotionIncrement increment_;
  Matrix9d covariance_ = Matrix9d::Zero();
  BiasJacobian bias_jacobian_ = BiasJacobian::Zero();
};

/// Readings of a body that keeps its velocity, rate zero, from state.t to `end`, none of which is a
/// measurement: for drives without an IMU.
preprocess::ImuSegment steady_readings(const NodeState& state, TimeNs end);

}  // namespace holdfast::estimator
