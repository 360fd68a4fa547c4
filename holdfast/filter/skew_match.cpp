#include "holdfast/filter/skew_match.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "holdfast/registration/degeneracy.hpp"

namespace holdfast::filter {
namespace {

constexpr std::size_t kBatch = 64;
constexpr int kResidual = 15;  // row below the unknowns

/// Marginalises an offset of the map out: it moves the scan as its pose and velocity do.
void marginalise(const MapError& error, SkewEquations& e) {
  auto& [H, g] = e;
  registration::Matrix9d S = H.topLeftCorner<9, 9>();
  S.topLeftCorner<3, 3>() += error.position.inverse();
  S.diagonal().segment<3>(FilterState::kR).array() += 1.0 / std::pow(error.rotation_rad, 2);
  S.diagonal().segment<3>(FilterState::kV).array() += 1.0 / std::pow(error.velocity_m_s, 2);
  const Eigen::LDLT<registration::Matrix9d> solver(S);
  const Eigen::Matrix<double, 15, 9> cross = H.leftCols<9>();
  g -= cross * solver.solve(g.head<9>());
  H -= cross * solver.solve(cross.transpose());
  H = (0.5 * (H + H.transpose())).eval();
}

}  // namespace

SkewEquations linearise_with_skew(const registration::Correspondences& pairs,
                                  const SE3& T_anchor_body, double robust_scale) {
  SkewEquations e;
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

SkewEquations SkewMatch::linearise(const MatchState& x) {
  deskew_scan(scan_, x, work_);
  if (clock_ != nullptr) clock_->book(Stage::kDeskew);
  const SE3 T_anchor_body{x.T_map_body.rotation, x.T_map_body.translation - map_.anchor()};
  map_.associate(T_anchor_body, scan_.T_body_lidar.translation, work_.points, options_.association,
                 pool_, work_.pairs);
  if (clock_ != nullptr) clock_->book(Stage::kAssociate);
  const double scale = options_.robust_scale * ScanMatch::anneal(calls_++);
  raw_ = registration::linearise(work_.pairs, T_anchor_body, scale, pool_, work_.partials);
  raw_.feigned = registration::feigned_information(raw_, work_.pairs, T_anchor_body, scale,
                                                   options_.few_pairs);
  SkewEquations e = linearise_with_skew(work_.pairs, T_anchor_body, scale);
  const double span = to_seconds(scan_.scan->end_time - scan_.scan->stamp);
  marginalise(map_error(options_, span, raw_), e);
  if (clock_ != nullptr) clock_->book(Stage::kSolve);
  return e;
}

}  // namespace holdfast::filter
