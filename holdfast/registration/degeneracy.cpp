#include "holdfast/registration/degeneracy.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace holdfast::registration {
namespace {

using Eigen::Matrix3d;
using Solver = Eigen::SelfAdjointEigenSolver<Matrix3d>;

constexpr double kNormalSigma = 0.005;  // rad, of the normals of a map
/// Sums of float products are good to about 1e-6 of the largest; less is no information.
constexpr double kLeastShare = 1e-5;

/// Inverse on the directions that hold information, zero on the others.
Matrix3d pseudo_inverse(const Matrix3d& m) {
  const Solver solver(m);
  const Eigen::Vector3d& values = solver.eigenvalues();
  const double least = kLeastShare * values[2];
  Eigen::Vector3d inverse = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    if (values[i] > least) inverse[i] = 1.0 / values[i];
  }
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

Matrix3d position_information(const Matrix9d& H) {
  const Matrix3d pr = H.block<3, 3>(kPosition, kRotation);
  const Matrix3d rr = H.block<3, 3>(kRotation, kRotation);
  return H.block<3, 3>(kPosition, kPosition) - pr * pseudo_inverse(rr) * pr.transpose();
}

Matrix3d feigned_offset(const Matrix9d& H) {
  constexpr double kNowhere = 100.0;  // m^2, where all of the information is feigned
  const Matrix3d information = position_information(H);
  const double by_normals = kNormalSigma * kNormalSigma * information.trace();
  const Solver solver(information);
  Eigen::Vector3d variance;
  for (int i = 0; i < 3; ++i) {
    const double seeming = std::max(solver.eigenvalues()[i], 1e-9);
    const double real = seeming - by_normals;
    variance[i] = real > 1.0 / kNowhere ? std::min(1.0 / real - 1.0 / seeming, kNowhere) : kNowhere;
  }
  return solver.eigenvectors() * variance.asDiagonal() * solver.eigenvectors().transpose();
}

std::vector<Eigen::Vector3d> weak_directions(const Matrix9d& H, double sigma_m) {
  Matrix3d information = position_information(H);
  information -= kNormalSigma * kNormalSigma * information.trace() * Matrix3d::Identity();
  const Solver solver(information);
  std::vector<Eigen::Vector3d> weak;
  for (int i = 0; i < 3; ++i) {
    if (solver.eigenvalues()[i] < 1.0 / (sigma_m * sigma_m))
      weak.push_back(solver.eigenvectors().col(i));
  }
  return weak;
}

}  // namespace holdfast::registration
