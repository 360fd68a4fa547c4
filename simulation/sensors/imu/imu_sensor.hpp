#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/core/random.hpp"
#include "holdfast/core/sensor_data.hpp"
#include "simulation/motion/trajectory.hpp"
#include "simulation/sensors/imu/axis_distortion.hpp"
#include "simulation/sensors/imu/imu_model.hpp"
#include "simulation/sensors/imu/vibration.hpp"

namespace holdfast::simulation {

/// A step of the biases that stays.
struct BiasJump {
  TimeNs t = 0;  ///< from the start of the log
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel = Eigen::Vector3d::Zero();
};

/// Measures angular rate and specific force with white noise, walking biases and the faults of its
/// model.
class ImuSensor {
 public:
  /// `samples` are taken, at k / rate from the start of the log. `jumps` in order of time.
  ImuSensor(const ImuModel& model, std::uint64_t seed, std::size_t samples,
            const std::vector<BiasJump>& jumps);

  /// Steps of the model's size in a direction drawn from `random`.
  static BiasJump draw_jump(const ImuModel& model, TimeNs t, RandomStream& random);

  TimeNs interval() const { return interval_; }

  /// What walks, jumps and flickers: all of the bias that an estimator could follow.
  struct Bias {
    Eigen::Vector3d gyro;
    Eigen::Vector3d accel;
  };
  const Bias& bias(std::size_t sample) const { return biases_[sample]; }

  const AxisDistortion& gyro() const { return gyro_; }
  const AxisDistortion& accelerometer() const { return accelerometer_; }

  /// Sample `sample` of a body in `motion`; to be called once for each sample, in order. The time
  /// is left for the caller to set.
  ImuSample measure(std::size_t sample, const MotionState& motion);

 private:
  ImuModel model_;
  TimeNs interval_;
  std::vector<Bias> biases_;
  AxisDistortion gyro_;
  AxisDistortion accelerometer_;
  Vibration vibration_;
  RandomStream gyro_noise_;
  RandomStream accel_noise_;
};

}  // namespace holdfast::simulation
