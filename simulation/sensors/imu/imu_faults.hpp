#pragma once

#include "holdfast/core/fields.hpp"

namespace holdfast::simulation {

/// What an IMU does beside white noise and walking biases. All zero: none of it.
/// A sample is the saturated and rounded (distortion * (motion + vibration) + biases + noise).
struct ImuFaults {
  double gyro_bias_instability = 0;    ///< rad/s, level of the flat part of the Allan deviation
  double accel_bias_instability = 0;   ///< m/s^2, likewise
  double gyro_scale_sigma = 0;         ///< of each axis, as a share; drawn once a seed
  double accel_scale_sigma = 0;        ///< likewise
  double gyro_misalignment_rad = 0;    ///< sigma of what an axis feels of each other; once a seed
  double accel_misalignment_rad = 0;   ///< likewise
  double gyro_full_scale_rad_s = 0;    ///< readings end here, both ways; 0: nowhere
  double accel_full_scale_m_s2 = 0;    ///< likewise
  double gyro_resolution_rad_s = 0;    ///< readings are multiples of this; 0: not rounded
  double accel_resolution_m_s2 = 0;    ///< likewise
  double gyro_vibration_rad_s = 0;     ///< amplitude of the first harmonic on each axis at 1 m/s
  double accel_vibration_m_s2 = 0;     ///< likewise
  double vibration_cycles_per_m = 50;  ///< of the first harmonic, along the way
  double low_pass_hz = 0;              ///< second-order Butterworth before sampling; 0: none

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("gyro_bias_instability", self.gyro_bias_instability,
          FieldDoc{"rad/s, level of the flat part of the Allan deviation", 0, 1});
    visit("accel_bias_instability", self.accel_bias_instability,
          FieldDoc{"m/s^2, likewise", 0, 10});
    visit("gyro_scale_sigma", self.gyro_scale_sigma,
          FieldDoc{"error of the scale of each axis, as a share; fixed over a drive", 0, 0.2});
    visit("accel_scale_sigma", self.accel_scale_sigma, FieldDoc{"likewise", 0, 0.2});
    visit("gyro_misalignment_rad", self.gyro_misalignment_rad,
          FieldDoc{"sigma of what an axis feels of each other one; fixed over a drive", 0, 0.2});
    visit("accel_misalignment_rad", self.accel_misalignment_rad, FieldDoc{"likewise", 0, 0.2});
    visit("gyro_full_scale_rad_s", self.gyro_full_scale_rad_s,
          FieldDoc{"readings end here, both ways; 0: nowhere", 0, 1000});
    visit("accel_full_scale_m_s2", self.accel_full_scale_m_s2, FieldDoc{"likewise", 0, 10000});
    visit("gyro_resolution_rad_s", self.gyro_resolution_rad_s,
          FieldDoc{"readings are multiples of this; 0: not rounded", 0, 1});
    visit("accel_resolution_m_s2", self.accel_resolution_m_s2, FieldDoc{"likewise", 0, 10});
    visit("gyro_vibration_rad_s", self.gyro_vibration_rad_s,
          FieldDoc{"amplitude of the first harmonic on each axis at 1 m/s; harmonics 2 to 4 are "
                   "1/2 to 1/4 of it, and all grow with the speed",
                   0, 100});
    visit("accel_vibration_m_s2", self.accel_vibration_m_s2, FieldDoc{"likewise", 0, 1000});
    visit("vibration_cycles_per_m", self.vibration_cycles_per_m,
          FieldDoc{"of the first harmonic, along the way", 0.01, 10000});
    visit("low_pass_hz", self.low_pass_hz,
          FieldDoc{"second-order Butterworth that vibration passes before it is sampled (and "
                   "aliased); 0: none",
                   0, 100000});
  }

  /// What an industrial MEMS IMU of the class of a Bosch BMI088 has. As quoted for it (not compared
  /// with its data sheet), a tolerance taken for three sigma: gyro instability 2 deg/h, scale 1 %,
  /// cross-axis 1 %; accelerometer cross-axis 0.5 %; full scales of 500 deg/s and 6 g in 16 bits;
  /// 64 Hz of bandwidth at 200 Hz. Of its class: accelerometer instability 0.03 mg (as an Xsens
  /// MTi-1), scale as its cross-axis. Chosen, without a source: the vibration of a wheeled robot
  /// whose motors turn 50 times a metre, some ten times the white noise of the default IMU.
  static ImuFaults usual();

  /// These, and of `others` all that are off here.
  ImuFaults completed_by(const ImuFaults& others) const;
};

}  // namespace holdfast::simulation
