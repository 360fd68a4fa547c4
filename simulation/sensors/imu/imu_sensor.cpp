#include "simulation/sensors/imu/imu_sensor.hpp"

#include <cmath>

#include "simulation/sensors/imu/flicker_bias.hpp"
#include "simulation/sensors/imu/normal_vector.hpp"

namespace holdfast::simulation {

using Eigen::Vector3d;

ImuSensor::ImuSensor(const ImuModel& model, std::uint64_t seed, std::size_t samples,
                     const std::vector<BiasJump>& jumps)
    : model_(model),
      interval_(from_seconds(1.0 / model.rate_hz)),
      gyro_(AxisDistortion::of_gyro(model.faults, seed)),
      accelerometer_(AxisDistortion::of_accelerometer(model.faults, seed)),
      vibration_(model.faults, to_seconds(interval_), seed),
      gyro_noise_(seed, "imu.gyro_noise"),
      accel_noise_(seed, "imu.accel_noise") {
  RandomStream gyro(seed, "imu.gyro_bias");
  RandomStream accel(seed, "imu.accel_bias");
  const double dt = to_seconds(interval_);
  FlickerBias gyro_flicker(model.faults.gyro_bias_instability, dt, seed, "imu.gyro_flicker");
  FlickerBias accel_flicker(model.faults.accel_bias_instability, dt, seed, "imu.accel_flicker");
  Bias walk{model.gyro_bias_initial * normal_vector(gyro),
            model.accel_bias_initial * normal_vector(accel)};
  const double root_dt = std::sqrt(1.0 / model.rate_hz);
  auto jump = jumps.begin();
  for (std::size_t i = 0; i < samples; ++i) {
    for (; jump != jumps.end() && jump->t <= static_cast<TimeNs>(i) * interval_; ++jump) {
      walk.gyro += jump->gyro;
      walk.accel += jump->accel;
    }
    biases_.push_back({walk.gyro + gyro_flicker.next(), walk.accel + accel_flicker.next()});
    walk.gyro += model.gyro_bias_walk * root_dt * normal_vector(gyro);
    walk.accel += model.accel_bias_walk * root_dt * normal_vector(accel);
  }
}

BiasJump ImuSensor::draw_jump(const ImuModel& model, TimeNs t, RandomStream& random) {
  const Vector3d gyro = normal_vector(random).normalized();
  const Vector3d accel = normal_vector(random).normalized();
  return {t, model.gyro_bias_jump * gyro, model.accel_bias_jump * accel};
}

// A white density sigma, averaged over one interval, has the standard deviation sigma * sqrt(rate).
ImuSample ImuSensor::measure(std::size_t sample, const MotionState& motion) {
  const Eigen::Quaterniond& R_map_body = motion.T_map_body.rotation;
  const double root_rate = std::sqrt(model_.rate_hz);
  const Bias& bias = biases_[sample];
  const Vibration::Shaking shaking = vibration_.next(motion.v_map.norm());
  const Vector3d rate = motion.omega_body + shaking.gyro_rad_s;
  const Vector3d force =
      R_map_body.conjugate() * (motion.a_map - model_.gravity_map) + shaking.accel_m_s2;
  ImuSample out;
  out.gyro_rad_s = gyro_.read(gyro_.distort(rate) + bias.gyro +
                              model_.gyro_noise_density * root_rate * normal_vector(gyro_noise_));
  out.accel_m_s2 =
      accelerometer_.read(accelerometer_.distort(force) + bias.accel +
                          model_.accel_noise_density * root_rate * normal_vector(accel_noise_));
  return out;
}

}  // namespace holdfast::simulation
