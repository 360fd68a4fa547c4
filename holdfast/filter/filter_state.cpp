#include "holdfast/filter/filter_state.hpp"

#include <algorithm>

namespace holdfast::filter {
namespace {

using Rows = Eigen::Matrix<double, 3, 15>;

/// The blocks of the transition matrix of the errors over `dt` that are not zero or identity.
struct Transition {
  Eigen::Matrix3d p_from_rotation, p_from_accel_bias;
  Eigen::Matrix3d v_from_rotation, v_from_accel_bias;
  Eigen::Matrix3d rotation_from_rotation, rotation_from_gyro_bias;
  double dt;
};

/// P <- F P F^T, by the rows of F that differ from the identity.
void transport(const Transition& f, Matrix15d& P) {
  const auto left = [&f](Matrix15d& m) {
    const Rows p = m.middleRows<3>(FilterState::kP);
    const Rows r = m.middleRows<3>(FilterState::kR);
    const Rows v = m.middleRows<3>(FilterState::kV);
    const Rows ba = m.middleRows<3>(FilterState::kBa);
    const Rows bg = m.middleRows<3>(FilterState::kBg);
    m.middleRows<3>(FilterState::kP) =
        p + f.dt * v + f.p_from_rotation * r + f.p_from_accel_bias * ba;
    m.middleRows<3>(FilterState::kR) =
        f.rotation_from_rotation * r + f.rotation_from_gyro_bias * bg;
    m.middleRows<3>(FilterState::kV) = v + f.v_from_rotation * r + f.v_from_accel_bias * ba;
  };
  left(P);
  P.transposeInPlace();
  left(P);
}

void add_noise(const ImuNoiseConfig& noise, double dt, Matrix15d& P) {
  const auto add = [&](int offset, double density) {
    P.diagonal().segment<3>(offset).array() += density * density * dt;
  };
  add(FilterState::kR, noise.gyro_noise_density);
  add(FilterState::kV, noise.accel_noise_density);
  add(FilterState::kBa, noise.accel_bias_walk);
  add(FilterState::kBg, noise.gyro_bias_walk);
}

/// Noise of an interval in which a reading is held.
ImuNoiseConfig held_noise(const ImuNoiseConfig& noise, double dt) {
  constexpr double kRateWander = 1.0;   // rad/s per sqrt(s)
  constexpr double kForceWander = 3.0;  // m/s^2 per sqrt(s)
  ImuNoiseConfig held = noise;
  held.gyro_noise_density = std::max(noise.gyro_noise_density, kRateWander * dt);
  held.accel_noise_density = std::max(noise.accel_noise_density, kForceWander * dt);
  if (dt < to_seconds(kLongestHold)) return held;
  held.gyro_bias_walk = std::max(noise.gyro_bias_walk, kRateWander);
  held.accel_bias_walk = std::max(noise.accel_bias_walk, kForceWander);
  return held;
}

/// One interval between neighbouring readings.
void step(FilterState& s, const ImuSample& a, const ImuSample& b, const Eigen::Vector3d& gravity,
          const ImuNoiseConfig& noise) {
  const double dt = to_seconds(b.t - a.t);
  const Eigen::Vector3d rate = 0.5 * (a.gyro_rad_s + b.gyro_rad_s) - s.gyro_bias;
  const Eigen::Vector3d force = 0.5 * (a.accel_m_s2 + b.accel_m_s2) - s.accel_bias;
  const Eigen::Quaterniond middle = s.T_map_body.rotation * so3::exp(0.5 * dt * rate);
  const Eigen::Matrix3d R = middle.toRotationMatrix();
  const Eigen::Vector3d acceleration = R * force + gravity;

  Transition f;
  f.dt = dt;
  f.v_from_rotation = -dt * R * so3::hat(force);
  f.v_from_accel_bias = -dt * R;
  f.p_from_rotation = 0.5 * dt * f.v_from_rotation;
  f.p_from_accel_bias = 0.5 * dt * f.v_from_accel_bias;
  f.rotation_from_rotation = so3::exp(-dt * rate).toRotationMatrix();
  f.rotation_from_gyro_bias = -dt * so3::right_jacobian(dt * rate);
  transport(f, s.P);
  add_noise(noise, dt, s.P);

  s.T_map_body.translation += dt * s.v_map + 0.5 * dt * dt * acceleration;
  s.T_map_body.rotation = (s.T_map_body.rotation * so3::exp(dt * rate)).normalized();
  s.v_map += dt * acceleration;
}

}  // namespace

void FilterState::set_biases(const Biases& biases) {
  accel_bias = biases.accel;
  gyro_bias = biases.gyro;
  P.rightCols<6>().setZero();
  P.bottomRows<6>().setZero();
  P.bottomRightCorner<6, 6>() = biases.P;
}

void FilterState::add(const Vector15d& e) {
  T_map_body.translation += e.segment<3>(kP);
  T_map_body.rotation = (T_map_body.rotation * so3::exp(e.segment<3>(kR))).normalized();
  v_map += e.segment<3>(kV);
  accel_bias += e.segment<3>(kBa);
  gyro_bias += e.segment<3>(kBg);
}

Vector15d FilterState::minus(const FilterState& other) const {
  Vector15d e;
  e << T_map_body.translation - other.T_map_body.translation,
      so3::log(other.T_map_body.rotation.conjugate() * T_map_body.rotation), v_map - other.v_map,
      accel_bias - other.accel_bias, gyro_bias - other.gyro_bias;
  return e;
}

void propagate(FilterState& state, const preprocess::ImuSegment& imu,
               const Eigen::Vector3d& gravity, const ImuNoiseConfig& noise) {
  for (std::size_t i = 0; i + 1 < imu.samples.size(); ++i) {
    const ImuSample& a = imu.samples[i];
    const ImuSample& b = imu.samples[i + 1];
    const bool held = a.t >= imu.measured_end || b.t <= imu.measured_begin;
    step(state, a, b, gravity, held ? held_noise(noise, to_seconds(b.t - a.t)) : noise);
  }
  if (!imu.samples.empty()) state.t = imu.samples.back().t;
}

}  // namespace holdfast::filter
