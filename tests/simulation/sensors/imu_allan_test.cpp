#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "simulation/sensors/imu/flicker_bias.hpp"
#include "simulation/sensors/imu/imu_file.hpp"
#include "simulation/sensors/imu/imu_sensor.hpp"
#include "tests/simulation/tolerances.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kRateHz = 100;
constexpr std::size_t kSamples = 4 * 3600 * 100;

/// Allan variance of three axes at one averaging time, from clusters that do not overlap.
class AllanVariance {
 public:
  explicit AllanVariance(double tau_s)
      : tau_s_(tau_s), size_(static_cast<std::size_t>(std::lround(tau_s * kRateHz))) {}

  void add(const Vector3d& value) {
    sum_ += value;
    if (++count_ < size_) return;
    const Vector3d mean = sum_ / static_cast<double>(size_);
    if (clusters_ > 0) squares_ += (mean - last_).squaredNorm();
    last_ = mean;
    ++clusters_;
    count_ = 0;
    sum_.setZero();
  }
  double tau_s() const { return tau_s_; }
  double differences() const { return 3 * (clusters_ - 1); }
  double variance() const { return squares_ / (2 * differences()); }

 private:
  double tau_s_;
  std::size_t size_;
  std::size_t count_ = 0;
  double clusters_ = 0;
  double squares_ = 0;
  Vector3d sum_ = Vector3d::Zero();
  Vector3d last_ = Vector3d::Zero();
};

struct Resting {
  std::vector<AllanVariance> gyro;
  std::vector<AllanVariance> accel;
};

/// Four hours of an IMU that lies still, at the averaging times that are asked for.
Resting rest(ImuModel model, const std::vector<double>& taus_s) {
  model.rate_hz = kRateHz;
  ImuSensor imu(model, 7, kSamples, {});
  Resting out;
  for (const double tau_s : taus_s) out.gyro.emplace_back(tau_s);
  out.accel = out.gyro;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const ImuSample sample = imu.measure(i, MotionState());
    for (AllanVariance& variance : out.gyro) variance.add(sample.gyro_rad_s);
    for (AllanVariance& variance : out.accel) variance.add(sample.accel_m_s2);
  }
  return out;
}

/// What the model says: white density N, flicker floor B and walk K (IEEE Std 952-1997, annex C).
double expected(double white, double floor, double walk, double tau_s) {
  return white * white / tau_s + floor * floor * FlickerBias::allan_variance(tau_s) +
         walk * walk * tau_s / 3;
}

void expect_as_model(const ImuModel& model, const std::vector<double>& taus_s) {
  const Resting still = rest(model, taus_s);
  for (std::size_t i = 0; i < taus_s.size(); ++i) {
    const double tau_s = taus_s[i];
    const double tolerance = tolerances::allan_variance(still.gyro[i].differences()) +
                             tolerances::allan_sampling(tau_s * kRateHz);
    EXPECT_NEAR(still.gyro[i].variance() / expected(model.gyro_noise_density,
                                                    model.faults.gyro_bias_instability,
                                                    model.gyro_bias_walk, tau_s),
                1, tolerance)
        << "gyro at " << tau_s << " s";
    EXPECT_NEAR(still.accel[i].variance() / expected(model.accel_noise_density,
                                                     model.faults.accel_bias_instability,
                                                     model.accel_bias_walk, tau_s),
                1, tolerance)
        << "accelerometer at " << tau_s << " s";
  }
}

TEST(ImuAllan, WhiteNoiseHasItsDensity) {
  ImuModel model = ImuModel::perfect();
  model.gyro_noise_density = 2e-4;
  model.accel_noise_density = 1.5e-3;
  expect_as_model(model, {0.1, 1, 10, 60});
}

TEST(ImuAllan, TheWalkGrowsAsTheRootOfTime) {
  ImuModel model = ImuModel::perfect();
  model.gyro_bias_walk = 1e-5;
  model.accel_bias_walk = 2e-4;
  expect_as_model(model, {1, 10, 100});
}

TEST(ImuAllan, BiasInstabilityHasItsFloor) {
  ImuModel model = ImuModel::perfect();
  model.faults.gyro_bias_instability = 1e-5;
  model.faults.accel_bias_instability = 3e-4;
  expect_as_model(model, {1, 8, 64, 256});
}

/// The three together, of an IMU as it is sold.
TEST(ImuAllan, ARealOneHasAllThree) {
  ImuModel model = *make_imu("bmi088");
  model.faults.gyro_resolution_rad_s = model.faults.accel_resolution_m_s2 = 0;
  model.faults.gyro_scale_sigma = model.faults.accel_scale_sigma = 0;
  model.gyro_bias_walk /= 100;  // else it hides the floor
  model.accel_bias_walk /= 100;
  expect_as_model(model, {0.1, 1, 8, 64, 256});
}

/// At the level of the configured floor, up to the ripple of processes a factor of 4 apart and
/// the ends of their row.
TEST(ImuAllan, TheFloorIsFlatFrom8To1000Seconds) {
  for (double tau_s = 8; tau_s <= 1000; tau_s *= 1.25) {
    EXPECT_NEAR(std::sqrt(FlickerBias::allan_variance(tau_s)), 1, 0.05) << tau_s;
  }
}

}  // namespace
}  // namespace holdfast::simulation
