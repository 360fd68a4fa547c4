#include "holdfast/preprocess/deskew.hpp"

#include <algorithm>

namespace holdfast::preprocess {
namespace {

/// Position and velocity of the body in the end-body frame while the IMU is integrated backwards.
struct Kinematics {
  SE3 T_end_body;
  Eigen::Vector3d velocity;
};

/// Bias-free mean reading of the interval between two samples.
struct MeanReading {
  Eigen::Vector3d gyro;
  Eigen::Vector3d accel;
};

MeanReading mean_of(const ImuSample& a, const ImuSample& b, const EndState& end) {
  return {0.5 * (a.gyro_rad_s + b.gyro_rad_s) - end.gyro_bias,
          0.5 * (a.accel_m_s2 + b.accel_m_s2) - end.accel_bias};
}

/// The state `dt` seconds before `k` (dt >= 0) at constant body rate and acceleration.
Kinematics step_back(const Kinematics& k, const MeanReading& reading, const EndState& end,
                     double dt) {
  const Eigen::Quaterniond middle = k.T_end_body.rotation * so3::exp(-0.5 * dt * reading.gyro);
  const Eigen::Vector3d acceleration = middle * reading.accel + end.gravity_end;
  Kinematics before;
  before.T_end_body.rotation = (k.T_end_body.rotation * so3::exp(-dt * reading.gyro)).normalized();
  before.T_end_body.translation =
      k.T_end_body.translation - dt * k.velocity + 0.5 * dt * dt * acceleration;
  before.velocity = k.velocity - dt * acceleration;
  return before;
}

}  // namespace

void ScanMotion::set_poses(const ImuSegment& imu, const EndState& end, TimeNs stamp,
                           TimeNs end_time) {
  poses_.resize(kKnots);
  Kinematics at_sample{SE3{}, end.v_end};
  std::size_t i = imu.samples.size() - 1;  // at_sample stands at the time of sample i
  // With a single reading no interval is left, and every knot is the end.
  MeanReading reading{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (int k = kKnots - 1; k >= 0; --k) {
    const TimeNs t = stamp + (end_time - stamp) * k / (kKnots - 1);
    while (i > 0 && imu.samples[i - 1].t >= t) {
      reading = mean_of(imu.samples[i - 1], imu.samples[i], end);
      at_sample =
          step_back(at_sample, reading, end, to_seconds(imu.samples[i].t - imu.samples[i - 1].t));
      --i;
    }
    if (i > 0) reading = mean_of(imu.samples[i - 1], imu.samples[i], end);
    const double dt = to_seconds(imu.samples[i].t - t);
    poses_[static_cast<std::size_t>(k)] = step_back(at_sample, reading, end, dt).T_end_body;
  }
}

void ScanMotion::set(const ImuSegment& imu, const EndState& end, const SE3& T_body_lidar,
                     TimeNs stamp, TimeNs end_time) {
  set_poses(imu, end, stamp, end_time);
  const auto span = static_cast<float>(end_time - stamp);
  knots_per_ns_ = span > 0 ? static_cast<float>(kKnots - 1) / span : 0.0F;
  const auto last = static_cast<std::size_t>(kKnots - 1);
  for (std::size_t k = 0; k <= last; ++k) {
    const auto matrix = [&](std::size_t i) {
      const SE3 T = poses_[i] * T_body_lidar;
      Eigen::Matrix<double, 3, 4> m;
      m << T.rotation.toRotationMatrix(), T.translation;
      return m;
    };
    const Eigen::Matrix<double, 3, 4> here = matrix(k);
    // Central difference inside, one-sided at both ends.
    const std::size_t a = k == 0 ? 0 : k - 1;
    const std::size_t b = k == last ? last : k + 1;
    const Eigen::Matrix<double, 3, 4> change = (matrix(b) - matrix(a)) / static_cast<double>(b - a);
    knots_[k].R = here.leftCols<3>().cast<float>();
    knots_[k].t = here.col(3).cast<float>();
    knots_[k].dR = change.leftCols<3>().cast<float>();
    knots_[k].dt = change.col(3).cast<float>();
  }
}

}  // namespace holdfast::preprocess
