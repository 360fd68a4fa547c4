#include "holdfast/estimator/preintegration.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::estimator {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

enum Block : int { kP = 0, kR = 3, kV = 6, kBa = 0, kBg = 3 };

// What the discretisation leaves, so that the covariance of even a perfect IMU can be inverted.
constexpr double kLeastSigmaP = 1e-6;
constexpr double kLeastSigmaR = 1e-7;
constexpr double kLeastSigmaV = 1e-6;

/// V(t) / sigma^2 of UnmeasuredMotion, s^2.
double wandering(double t, double tau) {
  const double u = std::exp(-t / tau);
  return std::max(0.0, tau * tau * (2 * t / tau - 3 + 4 * u - u * u));
}

/// The rows of the transition of the errors that are not trivial.
struct Transition {
  Matrix3d p_from_r, r_from_r, v_from_r;
  double dt;

  template <class Rows>
  void apply(Rows& m) const {
    using Three = Eigen::Matrix<double, 3, Rows::ColsAtCompileTime>;
    const Three r = m.template middleRows<3>(kR);
    m.template middleRows<3>(kP) += dt * m.template middleRows<3>(kV) + p_from_r * r;
    m.template middleRows<3>(kV) += v_from_r * r;
    m.template middleRows<3>(kR) = r_from_r * r;
  }
};

}  // namespace

void Preintegration::integrate(const preprocess::ImuSegment& imu, const Vector3d& accel_bias,
                               const Vector3d& gyro_bias, const Noise& noise) {
  imu_ = imu;
  noise_ = noise;
  accel_bias_ = accel_bias;
  gyro_bias_ = gyro_bias;
  run();
}

bool Preintegration::rebase(const Vector3d& accel_bias, const Vector3d& gyro_bias) {
  if ((gyro_bias - gyro_bias_).norm() * seconds_ <= kLargestTurn) return false;
  accel_bias_ = accel_bias;
  gyro_bias_ = gyro_bias;
  run();
  return true;
}

void Preintegration::run() {
  increment_ = {};
  covariance_.setZero();
  bias_jacobian_.setZero();
  seconds_ = 0;
  const filter::ImuNoiseConfig& imu = noise_.imu;
  const UnmeasuredMotion& unmeasured = noise_.unmeasured;
  for (std::size_t i = 0; i + 1 < imu_.samples.size(); ++i) {
    const ImuSample& a = imu_.samples[i];
    const ImuSample& b = imu_.samples[i + 1];
    const double dt = to_seconds(b.t - a.t);
    if (dt <= 0) continue;
    const double growth = wandered(a, b);
    const double accel = imu.accel_noise_density * imu.accel_noise_density * dt +
                         unmeasured.accel_sigma_m_s2 * unmeasured.accel_sigma_m_s2 * growth;
    const double gyro = imu.gyro_noise_density * imu.gyro_noise_density * dt +
                        unmeasured.gyro_sigma_rad_s * unmeasured.gyro_sigma_rad_s * growth;
    step(a, b, dt, accel, gyro);
    seconds_ += dt;
  }
  if (!imu_.samples.empty()) end_ = imu_.samples.back().t;
  covariance_.diagonal().segment<3>(kP).array() += kLeastSigmaP * kLeastSigmaP;
  covariance_.diagonal().segment<3>(kR).array() += kLeastSigmaR * kLeastSigmaR;
  covariance_.diagonal().segment<3>(kV).array() += kLeastSigmaV * kLeastSigmaV;
}

/// What V / sigma^2 grows by over an interval between neighbouring readings, s^2.
double Preintegration::wandered(const ImuSample& a, const ImuSample& b) const {
  const double tau = noise_.unmeasured.time_constant_s;
  const double dt = to_seconds(b.t - a.t);
  const bool held = a.t >= imu_.measured_end || b.t <= imu_.measured_begin;
  if (held) return wandering(dt, tau);
  return dt > noise_.unmeasured.longest_interval_s ? 2 * wandering(0.5 * dt, tau) : 0.0;
}

/// Forster eqs. 35 to 37 with the midpoint rule; the noise is that of the readings' integrals over
/// the interval (m/s)^2 and rad^2.
void Preintegration::step(const ImuSample& a, const ImuSample& b, double dt, double accel_variance,
                          double gyro_variance) {
  const Vector3d rate = 0.5 * (a.gyro_rad_s + b.gyro_rad_s) - gyro_bias_;
  const Vector3d force = 0.5 * (a.accel_m_s2 + b.accel_m_s2) - accel_bias_;
  const Eigen::Quaterniond half = so3::exp(0.5 * dt * rate);
  const Matrix3d R = (increment_.rotation * half).toRotationMatrix();
  const Matrix3d turned_force = -R * so3::hat(force);

  Transition f;
  f.dt = dt;
  f.v_from_r = dt * turned_force * half.conjugate().toRotationMatrix();
  f.p_from_r = 0.5 * dt * f.v_from_r;
  f.r_from_r = so3::exp(-dt * rate).toRotationMatrix();

  // Derivatives by the readings' biases; noise of the readings enters in the same way.
  Eigen::Matrix<double, 9, 3> from_gyro;
  const Matrix3d v_from_gyro = -0.5 * dt * dt * turned_force * so3::right_jacobian(0.5 * dt * rate);
  from_gyro << 0.5 * dt * v_from_gyro, -dt * so3::right_jacobian(dt * rate), v_from_gyro;
  f.apply(bias_jacobian_);
  bias_jacobian_.middleCols<3>(kBg) += from_gyro;
  bias_jacobian_.block<3, 3>(kP, kBa) -= 0.5 * dt * dt * R;
  bias_jacobian_.block<3, 3>(kV, kBa) -= dt * R;

  f.apply(covariance_);
  covariance_.transposeInPlace();
  f.apply(covariance_);
  covariance_ += (gyro_variance / (dt * dt)) * from_gyro * from_gyro.transpose();
  // White noise of the force within the interval, in closed form: isotropic whatever R is.
  covariance_.diagonal().segment<3>(kP).array() += accel_variance * dt * dt / 3;
  covariance_.diagonal().segment<3>(kV).array() += accel_variance;
  covariance_.block<3, 3>(kP, kV).diagonal().array() += 0.5 * dt * accel_variance;
  covariance_.block<3, 3>(kV, kP).diagonal().array() += 0.5 * dt * accel_variance;

  increment_.position += dt * increment_.velocity + 0.5 * dt * dt * (R * force);
  increment_.velocity += dt * (R * force);
  increment_.rotation = (increment_.rotation * so3::exp(dt * rate)).normalized();
}

MotionIncrement Preintegration::corrected(const Vector3d& accel_bias,
                                          const Vector3d& gyro_bias) const {
  Vector6d moved;
  moved.head<3>() = accel_bias - accel_bias_;
  moved.tail<3>() = gyro_bias - gyro_bias_;
  const Vector9d change = bias_jacobian_ * moved;
  return {increment_.rotation * so3::exp(change.segment<3>(kR)),
          increment_.position + change.segment<3>(kP), increment_.velocity + change.segment<3>(kV)};
}

NodeState Preintegration::predict(const NodeState& from) const {
  const MotionIncrement d = corrected(from.accel_bias, from.gyro_bias);
  NodeState to = from;
  const Eigen::Quaterniond& R = from.T_map_body.rotation;
  to.t = end_;
  to.T_map_body.translation +=
      seconds_ * from.v_map + 0.5 * seconds_ * seconds_ * from.gravity_map + R * d.position;
  to.T_map_body.rotation = (R * d.rotation).normalized();
  to.v_map += seconds_ * from.gravity_map + R * d.velocity;
  return to;
}

preprocess::ImuSegment steady_readings(const NodeState& state, TimeNs end) {
  const ImuSample reading{
      state.t, state.gyro_bias,
      state.accel_bias - state.T_map_body.rotation.conjugate() * state.gravity_map};
  preprocess::ImuSegment imu;
  imu.samples.assign(2, reading);
  imu.samples.back().t = end;
  imu.held_ns = imu.longest_gap_ns = end - state.t;
  imu.measured_begin = imu.measured_end = state.t;
  return imu;
}

}  // namespace holdfast::estimator
