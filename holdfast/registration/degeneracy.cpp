#include "holdfast/registration/degeneracy.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace holdfast::registration {
namespace {

using Eigen::Matrix3d;
using Solver = Eigen::SelfAdjointEigenSolver<Matrix3d>;

constexpr double kNormalSigma = 0.005;  // rad, of the normals of a map
/// Of a direction: more than errors of normals can give.
constexpr float kFacing = static_cast<float>(10 * kNormalSigma);
constexpr double kFewShare = 0.05;  // of the best known direction's information: more takes many
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

/// What the pairs that face along a direction say about it.
struct Facing {
  double information = 0;  ///< sum, 1/m^2
  double squares = 0;      ///< sum of squares
};

Facing facing(const Correspondences& pairs, const SE3& T_anchor_body, double robust_scale,
              const Eigen::Vector3d& direction) {
  const Eigen::Matrix3f R = T_anchor_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f t = T_anchor_body.translation.cast<float>();
  const Eigen::Vector3f u = direction.cast<float>();
  const auto scale_sq = static_cast<float>(robust_scale * robust_scale);
  Facing sum;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Vector3f n(pairs.nx[i], pairs.ny[i], pairs.nz[i]);
    const float along = n.dot(u);
    if (std::abs(along) < kFacing) continue;
    const Eigen::Vector3f q(pairs.px[i], pairs.py[i], pairs.pz[i]);
    const float r = n.dot(R * q + t) - pairs.offset[i];
    const float shrink = scale_sq / (scale_sq + r * r * pairs.information[i]);
    const double information = shrink * shrink * along * along * pairs.information[i];
    sum.information += information;
    sum.squares += information * information;
  }
  return sum;
}

/// The part of what few pairs say that is not to be believed.
double unproven(const Facing& few, double few_pairs) {
  if (few.squares <= 0) return 0;
  const double pairs = few.information * few.information / few.squares;
  const double doubt = (few_pairs / pairs) * (few_pairs / pairs);
  return few.information * doubt / (1.0 + doubt);
}

}  // namespace

Matrix3d position_information(const Matrix9d& H) {
  const Matrix3d pr = H.block<3, 3>(kPosition, kRotation);
  const Matrix3d rr = H.block<3, 3>(kRotation, kRotation);
  return H.block<3, 3>(kPosition, kPosition) - pr * pseudo_inverse(rr) * pr.transpose();
}

Matrix3d feigned_information(const NormalEquations& e, const Correspondences& pairs,
                             const SE3& T_anchor_body, double robust_scale, double few_pairs) {
  const Matrix3d information = position_information(e.H);
  const double by_normals = kNormalSigma * kNormalSigma * information.trace();
  const Solver solver(information);
  const Eigen::Vector3d& seeming = solver.eigenvalues();
  Eigen::Vector3d feigned;
  for (int i = 0; i < 3; ++i) {
    feigned[i] = by_normals;
    if (seeming[i] < kFewShare * seeming[2]) {
      const auto& direction = solver.eigenvectors().col(i);
      feigned[i] += unproven(facing(pairs, T_anchor_body, robust_scale, direction), few_pairs);
    }
    feigned[i] = std::clamp(feigned[i], 0.0, std::max(seeming[i], 0.0));
  }
  return solver.eigenvectors() * feigned.asDiagonal() * solver.eigenvectors().transpose();
}

Matrix3d feigned_offset(const NormalEquations& e) {
  constexpr double kNowhere = 100.0;  // m^2, where all of the information is feigned
  const Solver solver(position_information(e.H));
  Eigen::Vector3d variance;
  for (int i = 0; i < 3; ++i) {
    const auto& direction = solver.eigenvectors().col(i);
    const double seeming = std::max(solver.eigenvalues()[i], 1e-9);
    const double real = seeming - direction.dot(e.feigned * direction);
    variance[i] = real > 1.0 / kNowhere ? std::min(1.0 / real - 1.0 / seeming, kNowhere) : kNowhere;
  }
  return solver.eigenvectors() * variance.asDiagonal() * solver.eigenvectors().transpose();
}

std::vector<Eigen::Vector3d> few_told_directions(const NormalEquations& e) {
  const Solver solver(position_information(e.H));
  const Eigen::Vector3d& seeming = solver.eigenvalues();
  std::vector<Eigen::Vector3d> few;
  for (int i = 0; i < 2 && seeming[i] < kFewShare * seeming[2]; ++i) {
    few.push_back(solver.eigenvectors().col(i));
  }
  return few;
}

std::vector<Eigen::Vector3d> weak_directions(const NormalEquations& e, double sigma_m) {
  const Solver solver(position_information(e.H) - e.feigned);
  std::vector<Eigen::Vector3d> weak;
  for (int i = 0; i < 3; ++i) {
    if (solver.eigenvalues()[i] < 1.0 / (sigma_m * sigma_m))
      weak.push_back(solver.eigenvectors().col(i));
  }
  return weak;
}

}  // namespace holdfast::registration
