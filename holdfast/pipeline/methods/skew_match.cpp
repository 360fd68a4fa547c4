#include "holdfast/pipeline/methods/skew_match.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "holdfast/registration/degeneracy.hpp"

namespace holdfast::pipeline {
namespace {

using estimator::NodeState;
using filter::Matrix15d;
using filter::Vector15d;

constexpr std::size_t kBatch = 64;
constexpr int kResidual = 15;  // row below the unknowns
constexpr std::array<double, filter::ScanMatch::kCalls> kAnneal = {4.0, 2.0, 1.0};

/// Marginalises an offset of the map out: it moves the scan as its pose and velocity do.
void marginalise(const filter::MapError& error, Matrix15d& H, Vector15d& g) {
  registration::Matrix9d S = H.topLeftCorner<9, 9>();
  S.topLeftCorner<3, 3>() += error.position.inverse();
  S.diagonal().segment<3>(NodeState::kR).array() += 1.0 / std::pow(error.rotation_rad, 2);
  S.diagonal().segment<3>(NodeState::kV).array() += 1.0 / std::pow(error.velocity_m_s, 2);
  const Eigen::LDLT<registration::Matrix9d> solver(S);
  const Eigen::Matrix<double, 15, 9> cross = H.leftCols<9>();
  g -= cross * solver.solve(g.head<9>());
  H -= cross * solver.solve(cross.transpose());
  H = (0.5 * (H + H.transpose())).eval();
}

}  // namespace

void linearise_with_skew(const registration::Correspondences& pairs, const SE3& T_anchor_body,
                         double robust_scale, Matrix15d& H, Vector15d& g) {
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
      column.segment<3>(NodeState::kP) = n;
      column.segment<3>(NodeState::kR) = m;
      column.segment<3>(NodeState::kV) = age * n;
      column.segment<3>(NodeState::kBa) = -0.5F * age * age * u;
      column.segment<3>(NodeState::kBg) = -age * m;
      column[kResidual] = r;
      weighted.col(static_cast<Eigen::Index>(i - begin)) = shrink * shrink * information * column;
    }
    const Eigen::Matrix<float, 16, 16> sum = weighted * plain.transpose();
    H += sum.topLeftCorner<15, 15>().cast<double>();
    g += sum.topRightCorner<15, 1>().cast<double>();
  }
}

void SkewMatch::deskew(const NodeState& x) {
  const Scan& s = *scan_.scan;
  const Eigen::Quaterniond R_body_map = x.T_map_body.rotation.conjugate();
  work_.motion.set(scan_.imu,
                   {R_body_map * x.v_map, R_body_map * x.gravity_map, x.gyro_bias, x.accel_bias},
                   scan_.T_body_lidar, s.stamp, s.end_time);
  work_.points.resize(scan_.selected.size());
  const auto span_s = static_cast<float>(to_seconds(s.end_time - s.stamp));
  for (std::size_t i = 0; i < scan_.selected.size(); ++i) {
    const ScanPoint& p = s.points[scan_.selected[i]];
    work_.points.points[i] = work_.motion.deskew(p);
    work_.points.age_s[i] = static_cast<float>(p.time_offset_ns) * 1e-9F - span_s;
  }
  if (clock_ != nullptr) clock_->book(Stage::kDeskew);
}

estimator::MapFactor SkewMatch::linearise(const NodeState& x) {
  deskew(x);
  const SE3 T_anchor_body{x.T_map_body.rotation, x.T_map_body.translation - map_.anchor()};
  registration::associate(map_, T_anchor_body, scan_.T_body_lidar.translation, work_.points,
                          options_.association, pool_, work_.pairs);
  if (clock_ != nullptr) clock_->book(Stage::kAssociate);
  const double scale =
      options_.robust_scale * kAnneal[std::min<std::size_t>(calls_++, kAnneal.size() - 1)];
  raw_ = registration::linearise(work_.pairs, T_anchor_body, scale, pool_, work_.partials);
  raw_.feigned = registration::feigned_information(raw_, work_.pairs, T_anchor_body, scale,
                                                   options_.few_pairs);
  Matrix15d H = Matrix15d::Zero();
  Vector15d g = Vector15d::Zero();
  linearise_with_skew(work_.pairs, T_anchor_body, scale, H, g);
  const double span = to_seconds(scan_.scan->end_time - scan_.scan->stamp);
  marginalise(filter::map_error(options_, span, raw_), H, g);
  if (clock_ != nullptr) clock_->book(Stage::kSolve);
  return {H, g, raw_.cost, x};
}

}  // namespace holdfast::pipeline
