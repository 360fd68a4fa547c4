#include "simulation/sensors/imu/imu_faults.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "simulation/sensors/imu/imu_sensor.hpp"
#include "tests/simulation/support.hpp"
#include "tests/simulation/tolerances.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::make;
using testing::noise_free;
using testing::record;

ImuModel perfect_but(const ImuFaults& faults) {
  ImuModel model = ImuModel::perfect();
  model.faults = faults;
  return model;
}

MotionState turning(const Vector3d& omega_body) {
  MotionState motion;
  motion.omega_body = omega_body;
  return motion;
}

/// The body turned so that its axis `axis` points up, or down.
MotionState with_axis_up(int axis, bool up) {
  MotionState motion;
  const Vector3d direction = up ? Vector3d::Unit(axis) : Vector3d(-Vector3d::Unit(axis));
  motion.T_map_body.rotation.setFromTwoVectors(direction, Vector3d::UnitZ());
  return motion;
}

/// As a laboratory does it: turned about each axis at 1 rad/s, and put down on its six sides.
struct Calibration {
  Matrix3d gyro;
  Matrix3d accelerometer;
};
Calibration calibrate(ImuSensor& imu) {
  Calibration out;
  std::size_t sample = 0;
  for (int axis = 0; axis < 3; ++axis) {
    out.gyro.col(axis) = imu.measure(sample++, turning(Vector3d::Unit(axis))).gyro_rad_s;
    const Vector3d up = imu.measure(sample++, with_axis_up(axis, true)).accel_m_s2;
    const Vector3d down = imu.measure(sample++, with_axis_up(axis, false)).accel_m_s2;
    out.accelerometer.col(axis) = (up - down) / (2 * 9.81);
  }
  return out;
}

TEST(ImuFaults, ScaleAndMisalignmentAreFoundByACalibrationAndHaveTheirSizes) {
  ImuFaults faults;
  faults.gyro_scale_sigma = 0.01;
  faults.gyro_misalignment_rad = 0.002;
  faults.accel_scale_sigma = 0.003;
  faults.accel_misalignment_rad = 0.004;
  constexpr int kSeeds = 60;
  Calibration squares{Matrix3d::Zero(), Matrix3d::Zero()};
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    ImuSensor imu(perfect_but(faults), seed, 9, {});
    const Calibration found = calibrate(imu);
    ASSERT_LT((found.gyro - imu.gyro().matrix()).norm(), tolerances::kRounding);
    ASSERT_LT((found.accelerometer - imu.accelerometer().matrix()).norm(), tolerances::kRounding);
    squares.gyro += (found.gyro - Matrix3d::Identity()).cwiseAbs2();
    squares.accelerometer += (found.accelerometer - Matrix3d::Identity()).cwiseAbs2();
  }
  const auto expect_sizes = [](const Matrix3d& sum, double scale, double misalignment) {
    const double diagonal = sum.trace() / (3 * kSeeds);
    const double beside = (sum.sum() - sum.trace()) / (6 * kSeeds);
    EXPECT_NEAR(diagonal / (scale * scale), 1, tolerances::variance_error(3 * kSeeds));
    EXPECT_NEAR(beside / (misalignment * misalignment), 1, tolerances::variance_error(6 * kSeeds));
  };
  expect_sizes(squares.gyro, 0.01, 0.002);
  expect_sizes(squares.accelerometer, 0.003, 0.004);
}

TEST(ImuFaults, ReadingsEndAtTheFullScale) {
  ImuFaults faults;
  faults.gyro_full_scale_rad_s = 4;
  faults.accel_full_scale_m_s2 = 20;
  ImuSensor imu(perfect_but(faults), 1, 2, {});
  MotionState wild = turning({5, -6, 1});
  wild.a_map = {-30, 8, 10.5};
  const ImuSample clipped = imu.measure(0, wild);
  EXPECT_EQ(clipped.gyro_rad_s, Vector3d(4, -4, 1));
  EXPECT_EQ(clipped.accel_m_s2, Vector3d(-20, 8, 20));
  const ImuSample inside = imu.measure(1, turning({3.9, -3.9, 0}));
  EXPECT_EQ(inside.gyro_rad_s, Vector3d(3.9, -3.9, 0));
}

TEST(ImuFaults, ReadingsAreMultiplesOfTheResolution) {
  ImuModel model = ImuModel::perfect();
  model.faults.gyro_resolution_rad_s = 1e-3;
  model.gyro_noise_density = 1e-3;  // many steps wide: rounding errors are spread evenly
  constexpr std::size_t kSamples = 20000;
  ImuSensor rounded(model, 3, kSamples, {});
  model.faults.gyro_resolution_rad_s = 0;
  ImuSensor exact(model, 3, kSamples, {});
  double squares = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const Vector3d reading = rounded.measure(i, MotionState()).gyro_rad_s;
    const Vector3d steps = reading / 1e-3;
    ASSERT_LT((steps - steps.array().round().matrix()).norm(), 1000 * tolerances::kRounding);
    squares += (reading - exact.measure(i, MotionState()).gyro_rad_s).squaredNorm();
  }
  // The fourth moment of an even spread is smaller than that of a normal one.
  EXPECT_NEAR(squares / (3 * kSamples) / (1e-6 / 12), 1, tolerances::variance_error(3 * kSamples));
}

/// One second of shaking at a speed that does not change.
std::vector<ImuSample> shake(const ImuFaults& faults, double speed_m_s) {
  constexpr std::size_t kSamples = 200;
  ImuSensor imu(perfect_but(faults), 5, kSamples, {});
  MotionState motion;
  motion.v_map = {speed_m_s, 0, 0};
  std::vector<ImuSample> samples;
  for (std::size_t i = 0; i < kSamples; ++i) samples.push_back(imu.measure(i, motion));
  return samples;
}

/// Amplitude of the tone of so many Hz on the x axis of the gyro.
double tone(const std::vector<ImuSample>& samples, int frequency_hz) {
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double angle = 2 * std::numbers::pi * frequency_hz * static_cast<double>(i) / 200;
    sum += std::polar(samples[i].gyro_rad_s.x(), -angle);
  }
  return 2 * std::abs(sum) / static_cast<double>(samples.size());
}

// 170, 340, 510 and 680 Hz in samples of 200 Hz: whole cycles a second, so that sums are exact.
TEST(ImuFaults, VibrationAboveHalfTheRateComesBackAliased) {
  ImuFaults faults;
  faults.gyro_vibration_rad_s = 0.3;
  faults.vibration_cycles_per_m = 170;
  faults.low_pass_hz = 100;
  const auto samples = shake(faults, 1);
  const int aliases[] = {30, 60, 90, 80};
  for (int k = 1; k <= 4; ++k) {
    const double passed = 1 / std::sqrt(1 + std::pow(1.7 * k, 4));
    EXPECT_NEAR(tone(samples, aliases[k - 1]), 0.3 / k * passed, 200 * tolerances::kRounding) << k;
  }
  for (const int silent : {10, 20, 40, 50, 70}) {
    EXPECT_NEAR(tone(samples, silent), 0, 200 * tolerances::kRounding) << silent;
  }
}

double accel_power(const std::vector<ImuSample>& samples) {
  double sum = 0;
  for (const ImuSample& sample : samples) {
    sum += (sample.accel_m_s2 - Vector3d(0, 0, 9.81)).squaredNorm();
  }
  return sum / (3 * static_cast<double>(samples.size()));
}

TEST(ImuFaults, ThePowerOfVibrationGrowsWithTheSquareOfTheSpeed) {
  ImuFaults faults;
  faults.accel_vibration_m_s2 = 2;
  faults.vibration_cycles_per_m = 17;
  const double harmonics = 1 + 1 / 4.0 + 1 / 9.0 + 1 / 16.0;
  for (const double speed : {0.0, 1.0, 2.0}) {
    const double power = 2 * 2 * speed * speed / 2 * harmonics;
    EXPECT_NEAR(accel_power(shake(faults, speed)), power, 200 * tolerances::kRounding) << speed;
  }
}

TEST(ImuFaults, TheTrueBiasIncludesItsInstability) {
  SimulationOptions options = noise_free("box", 5);
  options.lidar.columns = 1;
  options.imu.faults.gyro_bias_instability = 1e-3;
  options.imu.faults.accel_bias_instability = 1e-2;
  const auto simulation = make(options);
  double largest_change = 0;
  const Vector3d first = simulation->state_at(simulation->start_time()).gyro_bias;
  for (const ImuSample& sample : record(*simulation).imu) {
    const TrueState truth = simulation->state_at(sample.t);
    const Vector3d felt =
        truth.T_map_body.rotation.conjugate() * (truth.a_map - options.imu.gravity_map);
    ASSERT_LT((sample.gyro_rad_s - truth.omega_body - truth.gyro_bias).norm(), 1e-15);
    ASSERT_LT((sample.accel_m_s2 - felt - truth.accel_bias).norm(), 1e-14);
    largest_change = std::max(largest_change, (truth.gyro_bias - first).norm());
  }
  EXPECT_GT(largest_change, 1e-3) << "it wanders";
}

TEST(ImuFaults, UsualOnesFillInWhatASensorDoesNotSay) {
  ImuModel model;
  model.faults.gyro_scale_sigma = 0.05;
  const ImuModel faulty = model.with_usual_faults();
  EXPECT_EQ(faulty.faults.gyro_scale_sigma, 0.05);
  EXPECT_EQ(faulty.faults.accel_scale_sigma, ImuFaults::usual().accel_scale_sigma);
  EXPECT_EQ(faulty.faults.low_pass_hz, 64);
  EXPECT_EQ(faulty.gyro_noise_density, model.gyro_noise_density);
  EXPECT_EQ(model.faults.low_pass_hz, 0);
}

}  // namespace
}  // namespace holdfast::simulation
