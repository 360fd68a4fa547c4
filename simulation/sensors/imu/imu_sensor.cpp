#include "simulation/sensors/imu/imu_sensor.hpp"

#include <cmath>

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

Vector3d normals(RandomStream& random) {
  const double x = random.normal();
  const double y = random.normal();
  return {x, y, random.normal()};
}

}  // namespace

ImuSensor::ImuSensor(const ImuModel& model, std::uint64_t seed, std::size_t samples,
                     const std::vector<BiasJump>& jumps)
    : model_(model),
      interval_(from_seconds(1.0 / model.rate_hz)),
      gyro_noise_(seed, "imu.gyro_noise"),
      accel_noise_(seed, "imu.accel_noise") {
  RandomStream gyro(seed, "imu.gyro_bias");
  RandomStream accel(seed, "imu.accel_bias");
  Bias walk{model.gyro_bias_initial * normals(gyro), model.accel_bias_initial * normals(accel)};
  const double root_dt = std::sqrt(1.0 / model.rate_hz);
  auto jump = jumps.begin();
  for (std::size_t i = 0; i < samples; ++i) {
    for (; jump != jumps.end() && jump->t <= static_cast<TimeNs>(i) * interval_; ++jump) {
      walk.gyro += jump->gyro;
      walk.accel += jump->accel;
    }
    biases_.push_back(walk);
    walk.gyro += model.gyro_bias_walk * root_dt * normals(gyro);
    walk.accel += model.accel_bias_walk * root_dt * normals(accel);
  }
}

BiasJump ImuSensor::draw_jump(const ImuModel& model, TimeNs t, RandomStream& random) {
  const Vector3d gyro = normals(random).normalized();
  const Vector3d accel = normals(random).normalized();
  return {t, model.gyro_bias_jump * gyro, model.accel_bias_jump * accel};
}

// A white density sigma, averaged over one interval, has the standard deviation sigma * sqrt(rate).
ImuSample ImuSensor::measure(std::size_t sample, const MotionState& motion) {
  const Eigen::Quaterniond& R_map_body = motion.T_map_body.rotation;
  const double root_rate = std::sqrt(model_.rate_hz);
  const Bias& bias = biases_[sample];
  ImuSample out;
  out.gyro_rad_s =
      motion.omega_body + bias.gyro + model_.gyro_noise_density * root_rate * normals(gyro_noise_);
  out.accel_m_s2 = R_map_body.conjugate() * (motion.a_map - model_.gravity_map) + bias.accel +
                   model_.accel_noise_density * root_rate * normals(accel_noise_);
  return out;
}

}  // namespace holdfast::simulation
