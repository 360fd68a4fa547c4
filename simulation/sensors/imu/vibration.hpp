#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "simulation/sensors/imu/imu_faults.hpp"

namespace holdfast::simulation {

/// The shaking that motors and wheels give an IMU: harmonics 1 to 4 of a tone of so many cycles a
/// metre, on each axis with a phase of its own, whose amplitudes are those of the model times the
/// speed in m/s divided by the number of the harmonic. They pass the low-pass of the IMU and are
/// then taken at the times of its samples, so that what the filter lets through above half the
/// rate comes back aliased. The motion itself is far below the filter's edge and stays as it is;
/// as a motion the shaking is some micrometres, which no LiDAR sees.
class Vibration {
 public:
  static constexpr int kHarmonics = 4;

  /// Phases are drawn from the stream "imu.vibration".
  Vibration(const ImuFaults& faults, double interval_s, std::uint64_t seed);

  struct Shaking {
    Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
    Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
  };
  /// At the next sample, at which the body has this speed. Zero when it is off.
  Shaking next(double speed_m_s);

  /// |H| of the low-pass at `frequency_hz`.
  static double gain(double frequency_hz, double low_pass_hz);

 private:
  ImuFaults faults_;
  double interval_s_;
  double cycles_ = 0;  ///< of the first harmonic since the start
  double last_speed_m_s_ = 0;
  std::array<Eigen::Vector3d, kHarmonics> gyro_phases_rad_;
  std::array<Eigen::Vector3d, kHarmonics> accel_phases_rad_;
};

}  // namespace holdfast::simulation
