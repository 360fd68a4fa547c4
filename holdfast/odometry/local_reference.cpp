#include "holdfast/odometry/local_reference.hpp"

#include <Eigen/Eigenvalues>

namespace holdfast::odometry {
namespace {

using filter::FilterState;
using filter::Matrix15d;

constexpr double kDriftM = 0.02;  // error from which the map does not hold the robot
constexpr double kFreshM = 0.01;  // error of what was put into the map a moment ago

}  // namespace

Matrix15d count_from_here(FilterState& state) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      state.P.block<3, 3>(FilterState::kP, FilterState::kP));
  Eigen::Matrix3d drifting = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    if (solver.eigenvalues()[i] < kDriftM * kDriftM) continue;
    const Eigen::Vector3d u = solver.eigenvectors().col(i);
    drifting += u * u.transpose();
  }
  Matrix15d kept = Matrix15d::Identity();
  if (drifting.isZero()) return kept;
  kept.block<3, 3>(FilterState::kP, FilterState::kP) -= drifting;
  state.P = kept * state.P * kept.transpose();
  state.P.block<3, 3>(FilterState::kP, FilterState::kP) += kFreshM * kFreshM * drifting;
  state.P = (0.5 * (state.P + state.P.transpose())).eval();
  return kept;
}

}  // namespace holdfast::odometry
