#include "holdfast/filter/matching/skew_equations.hpp"

#include <algorithm>

namespace holdfast::filter {
namespace {

constexpr std::size_t kBatch = 64;
constexpr int kResidual = 15;  // row below the unknowns

}  // namespace

ScanEquations linearise_with_skew(const registration::Correspondences& pairs,
                                  const SE3& T_anchor_body, double robust_scale) {
  ScanEquations e;
  const Eigen::Matrix3f R = T_anchor_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f p = T_anchor_body.translation.cast<float>();
  const auto scale_sq = static_cast<float>(robust_scale * robust_scale);
  // Columns: Jacobian and residual of a point, as they are and weighted.
  Eigen::Matrix<float, 16, kBatch> plain;
  Eigen::Matrix<float, 16, kBatch> weighted;
  for (std::size_t begin = 0; begin < pairs.size(); begin += kBatch) {
    plain.setZero();
    weighted.setZero();
    for (std::size_t i = begin; i < std::min(begin + kBatch, pairs.size()); ++i) {
      const float information = pairs.information[i];
      if (information <= 0) continue;
      const Eigen::Vector3f n(pairs.nx[i], pairs.ny[i], pairs.nz[i]);
      const Eigen::Vector3f q(pairs.px[i], pairs.py[i], pairs.pz[i]);
      const Eigen::Vector3f u = R.transpose() * n;
      const float r = u.dot(q) + n.dot(p) - pairs.offset[i];
      const float shrink = scale_sq / (scale_sq + r * r * information);
      const float age = pairs.age_s[i];
      const Eigen::Vector3f m = q.cross(u);
      auto column = plain.col(static_cast<Eigen::Index>(i - begin));
      column.segment<3>(FilterState::kP) = n;
      column.segment<3>(FilterState::kR) = m;
      column.segment<3>(FilterState::kV) = age * n;
      column.segment<3>(FilterState::kBa) = -0.5F * age * age * u;
      column.segment<3>(FilterState::kBg) = -age * m;
      column[kResidual] = r;
      weighted.col(static_cast<Eigen::Index>(i - begin)) = shrink * shrink * information * column;
    }
    const Eigen::Matrix<float, 16, 16> sum = weighted * plain.transpose();
    e.H += sum.topLeftCorner<15, 15>().cast<double>();
    e.g += sum.topRightCorner<15, 1>().cast<double>();
  }
  return e;
}

}  // namespace holdfast::filter
