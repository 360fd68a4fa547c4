#include "simulation/sensors/imu/imu_sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/simulation/imu_integration.hpp"
#include "tests/simulation/support.hpp"
#include "tests/simulation/tolerances.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;
using testing::integrate;
using testing::Integrated;
using testing::make;
using testing::noise_free;
using testing::record;

constexpr double kStep = 0.005;  // of the default IMU

TEST(ImuSensor, WithoutNoiseIntegratesBackToTheTruth) {
  for (const char* scenario : {"box", "corridor", "hall", "office"}) {
    SimulationOptions options = noise_free(scenario, 30);
    options.lidar.columns = 1;
    const auto simulation = make(options);
    const auto log = record(*simulation);
    const TrueState begin = simulation->state_at(simulation->start_time());
    const Integrated end =
        integrate(log.imu, {begin.T_map_body, begin.v_map}, options.imu.gravity_map, kStep);
    ASSERT_EQ(log.imu.size(), 6001U);
    const SE3 truth = simulation->truth_at(log.imu.back().t);
    EXPECT_LT(so3::angle_between(end.pose.rotation, truth.rotation),
              tolerances::integrated_attitude(30, 2 * kStep));
    EXPECT_LT((end.pose.translation - truth.translation).norm(),
              tolerances::integrated_position(30, 2 * kStep));
  }
}

// Steps of the integration must resolve the wobble: at 1 kHz the fourth-order rule does.
TEST(ImuSensor, WithoutNoiseIntegratesBackToTheTruthWithWobbleAndTwiceTheSpeed) {
  for (const char* scenario : {"corridor", "tunnel", "offices"}) {
    SimulationOptions options = noise_free(scenario, 20);
    options.lidar.columns = 1;
    options.wobble_rad = 0.1;
    options.speed_factor = 2;
    options.imu.rate_hz = 1000;
    const auto simulation = make(options);
    const auto log = record(*simulation);
    const TrueState begin = simulation->state_at(simulation->start_time());
    const Integrated end =
        integrate(log.imu, {begin.T_map_body, begin.v_map}, options.imu.gravity_map, 0.001);
    const SE3 truth = simulation->truth_at(log.imu.back().t);
    EXPECT_LT(so3::angle_between(end.pose.rotation, truth.rotation),
              tolerances::integrated_attitude(20, 0.002, 0.1))
        << scenario;
    EXPECT_LT((end.pose.translation - truth.translation).norm(),
              tolerances::integrated_position(20, 0.002, 0.1))
        << scenario;
  }
}

TEST(ImuSensor, AtRestReadsGravityUpwards) {
  const auto simulation = make(noise_free("box", 2));
  for (const ImuSample& sample : record(*simulation).imu) {
    EXPECT_NEAR((sample.accel_m_s2 - Vector3d(0, 0, 9.81)).norm(), 0, 1e-8);
    EXPECT_NEAR(sample.gyro_rad_s.norm(), 0, 1e-10);
  }
}

TEST(ImuSensor, HasTheNoiseDensitiesOfItsModel) {
  SimulationOptions options;
  options.scenario = "corridor";
  options.duration_s = 60;
  options.lidar.columns = 1;
  const auto simulation = make(options);
  double gyro = 0;
  double accel = 0;
  double lagged = 0;
  Vector3d last = Vector3d::Zero();
  const auto log = record(*simulation);
  for (const ImuSample& sample : log.imu) {
    const TrueState truth = simulation->state_at(sample.t);
    const Vector3d felt =
        truth.T_map_body.rotation.conjugate() * (truth.a_map - options.imu.gravity_map);
    const Vector3d gyro_noise = sample.gyro_rad_s - truth.omega_body - truth.gyro_bias;
    gyro += gyro_noise.squaredNorm();
    accel += (sample.accel_m_s2 - felt - truth.accel_bias).squaredNorm();
    lagged += gyro_noise.dot(last);
    last = gyro_noise;
  }
  const double n = 3.0 * static_cast<double>(log.imu.size());
  const double gyro_variance = std::pow(options.imu.gyro_noise_density, 2) * 200;
  const double accel_variance = std::pow(options.imu.accel_noise_density, 2) * 200;
  EXPECT_NEAR(gyro / n / gyro_variance, 1, tolerances::variance_error(n));
  EXPECT_NEAR(accel / n / accel_variance, 1, tolerances::variance_error(n));
  EXPECT_NEAR(lagged / n / gyro_variance, 0, tolerances::mean_error(1, n)) << "white";
}

TEST(ImuSensor, BiasesWalkAsTheRootOfTime) {
  const ImuModel model;
  constexpr int kSeeds = 40;
  for (const std::size_t samples : {201U, 2001U}) {
    double gyro = 0;
    double accel = 0;
    double start = 0;
    for (int seed = 0; seed < kSeeds; ++seed) {
      const ImuSensor imu(model, static_cast<std::uint64_t>(seed), samples, {});
      gyro += (imu.bias(samples - 1).gyro - imu.bias(0).gyro).squaredNorm();
      accel += (imu.bias(samples - 1).accel - imu.bias(0).accel).squaredNorm();
      start += imu.bias(0).gyro.squaredNorm();
    }
    const double n = 3 * kSeeds;
    const double seconds = static_cast<double>(samples - 1) * kStep;
    EXPECT_NEAR(gyro / n / (std::pow(model.gyro_bias_walk, 2) * seconds), 1,
                tolerances::variance_error(n));
    EXPECT_NEAR(accel / n / (std::pow(model.accel_bias_walk, 2) * seconds), 1,
                tolerances::variance_error(n));
    EXPECT_NEAR(start / n / std::pow(model.gyro_bias_initial, 2), 1, tolerances::variance_error(n));
  }
}

TEST(ImuSensor, BiasJumpStepsByItsSizeAndStays) {
  const ImuModel model = ImuModel::perfect();
  RandomStream random(1, "jump");
  const BiasJump jump = ImuSensor::draw_jump(model, kSecond, random);
  EXPECT_NEAR(jump.gyro.norm(), 0.03, 1e-15);
  EXPECT_NEAR(jump.accel.norm(), 0.3, 1e-15);
  const ImuSensor imu(model, 1, 1001, {jump});
  EXPECT_EQ(imu.bias(199).gyro.norm(), 0);
  EXPECT_EQ(imu.bias(200).gyro, jump.gyro);
  EXPECT_EQ(imu.bias(1000).accel, jump.accel);
}

}  // namespace
}  // namespace holdfast::simulation
