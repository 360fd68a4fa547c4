#include "holdfast/filter/account.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace holdfast::filter {

double largest_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
}

void report_match(const registration::NormalEquations& e, std::size_t selected,
                  StepReport& report) {
  report.matches = static_cast<int>(e.pairs);
  report.inlier_share = selected == 0 ? 0.0 : e.weight / static_cast<double>(selected);
  report.mean_abs_residual_m = e.weight > 0 ? e.abs_residual / e.weight : 0.0;
}

void report_covariance(const Matrix6d& P, StepReport& report) {
  report.pose_covariance = P;
  report.sigma_trans_m = largest_sigma(P, FilterState::kP);
  report.sigma_rot_rad = largest_sigma(P, FilterState::kR);
}

}  // namespace holdfast::filter
