#include "holdfast/filter/rest.hpp"

#include <Eigen/Cholesky>

namespace holdfast::filter {
namespace {

constexpr double kFeltForce = 0.05;   // m/s^2
constexpr double kFeltRate = 0.01;    // rad/s
constexpr double kRestSigma = 0.005;  // m/s, of what is called standing still

}  // namespace

bool Rest::holds(const preprocess::ImuSegment& imu) {
  if (!rests_ || imu.samples.empty() || imu.held_ns > kLongestHold) return rests_ = false;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  for (const ImuSample& s : imu.samples) {
    force += s.accel_m_s2;
    rate += s.gyro_rad_s;
  }
  force /= static_cast<double>(imu.samples.size());
  rate /= static_cast<double>(imu.samples.size());
  const bool felt =
      scans_ > 0 && ((force - force_).norm() > kFeltForce || (rate - rate_).norm() > kFeltRate);
  rests_ = !felt;
  ++scans_;
  force_ += (force - force_) / scans_;
  rate_ += (rate - rate_) / scans_;
  return rests_;
}

Matrix15d Rest::correct(FilterState& state) {
  const Eigen::Matrix<double, 15, 3> PHt = state.P.middleCols<3>(FilterState::kV);
  const Eigen::Matrix3d S =
      PHt.middleRows<3>(FilterState::kV) + kRestSigma * kRestSigma * Eigen::Matrix3d::Identity();
  const Eigen::Matrix<double, 15, 3> gain = S.ldlt().solve(PHt.transpose()).transpose();
  Matrix15d left = Matrix15d::Identity();
  left.middleCols<3>(FilterState::kV) -= gain;
  state.add(-gain * state.v_map);
  // Joseph's form: stays positive.
  state.P = left * state.P * left.transpose() + kRestSigma * kRestSigma * gain * gain.transpose();
  state.P = (0.5 * (state.P + state.P.transpose())).eval();
  return left;
}

}  // namespace holdfast::filter
