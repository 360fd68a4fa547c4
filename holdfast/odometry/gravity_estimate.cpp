#include "holdfast/odometry/gravity_estimate.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "holdfast/odometry/increment.hpp"

namespace holdfast::odometry {
namespace {

using filter::FilterState;
using filter::Matrix15d;

constexpr double kSizeSigma = 0.01;      // m/s^2, gravity over the Earth and heights
constexpr double kWander = 1e-5;         // m/s^2/sqrt(s), against rounding
constexpr double kDirectionSigma = 3.0;  // m/s^2, before the readings tell it

}  // namespace

void GravityEstimate::begin(const Eigen::Vector3d& force, double acceleration_sigma, double size,
                            FilterState& state) {
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  gravity_ = {0, 0, -size};
  const Eigen::Matrix3d R = state.T_map_body.rotation.toRotationMatrix();
  // Unknowns [bias, gravity]; measured: R (force - bias) + gravity = 0.
  Matrix6d P = Matrix6d::Zero();
  P.topLeftCorner<3, 3>() = state.P.block<3, 3>(FilterState::kBa, FilterState::kBa);
  P.diagonal().tail<3>() << kDirectionSigma * kDirectionSigma, kDirectionSigma * kDirectionSigma,
      kSizeSigma * kSizeSigma;
  Eigen::Matrix<double, 3, 6> J;
  J << -R, Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d S =
      J * P * J.transpose() + acceleration_sigma * acceleration_sigma * Eigen::Matrix3d::Identity();
  const Eigen::Matrix<double, 6, 3> gain = S.ldlt().solve(J * P).transpose();
  const Vector6d x = gain * -(R * (force - state.accel_bias) + gravity_);
  P -= gain * J * P;
  state.accel_bias += x.head<3>();
  gravity_ += x.tail<3>();
  state.P.block<3, 3>(FilterState::kBa, FilterState::kBa) = P.topLeftCorner<3, 3>();
  P_ = P.bottomRightCorner<3, 3>();
  cross_.setZero();
  cross_.middleCols<3>(FilterState::kBa) = P.bottomLeftCorner<3, 3>();
}

Matrix15d GravityEstimate::predict(const FilterState& before, FilterState& predicted) {
  const double dt = to_seconds(predicted.t - before.t);
  const Matrix15d F = error_transition(before, predicted, gravity_);
  Eigen::Matrix<double, 15, 3> G = Eigen::Matrix<double, 15, 3>::Zero();
  G.middleRows<3>(FilterState::kP) = 0.5 * dt * dt * Eigen::Matrix3d::Identity();
  G.middleRows<3>(FilterState::kV) = dt * Eigen::Matrix3d::Identity();
  const Eigen::Matrix<double, 3, 15> carried = cross_ * F.transpose();
  const Matrix15d mixed = G * carried;
  predicted.P += F * before.P * F.transpose() + mixed + mixed.transpose() + G * P_ * G.transpose();
  predicted.P = (0.5 * (predicted.P + predicted.P.transpose())).eval();
  const Matrix15d with_before = F * before.P + G * cross_;
  cross_ = carried + P_ * G.transpose();
  P_.diagonal().array() += kWander * kWander * dt;
  return with_before;
}

Eigen::Matrix<double, 3, 15> GravityEstimate::correct(const FilterState& predicted,
                                                      const FilterState& after) {
  const Eigen::Matrix<double, 3, 15> gain =
      predicted.P.ldlt().solve(cross_.transpose()).transpose();
  gravity_ += gain * after.minus(predicted);
  // What the state says nothing about, and what it does: a sum of squares, whatever the rounding.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> rest(P_ - gain * cross_.transpose());
  const Eigen::Matrix3d& V = rest.eigenvectors();
  P_ = V * rest.eigenvalues().cwiseMax(0.0).asDiagonal() * V.transpose() +
       gain * after.P * gain.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  cross_ = gain * after.P;
  return gain;
}

void GravityEstimate::allow_for(const BiasJump& jump) {
  gravity_ += jump.gravity * jump.size;
  P_ += jump.gravity * jump.P * jump.gravity.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  cross_ += jump.gravity * jump.P * jump.now.transpose();
}

void GravityEstimate::forget_pose() { cross_.leftCols<9>().setZero(); }

void GravityEstimate::forget_biases() { cross_.rightCols<6>().setZero(); }

}  // namespace holdfast::odometry
