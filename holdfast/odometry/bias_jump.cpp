#include "holdfast/odometry/bias_jump.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "holdfast/odometry/increment.hpp"

namespace holdfast::odometry {
namespace {

using filter::FilterState;
using filter::Matrix15d;
using Vector6d = BiasJump::Vector6d;

constexpr double kAccelSigma = 0.3;  // m/s^2, of jumps
constexpr double kGyroSigma = 0.03;  // rad/s
constexpr double kLargest = 3.0;     // sigmas
constexpr double kLikely = 500.0;    // twice the log likelihood ratio
constexpr double kExplained = 0.95;  // of what was surprising
constexpr double kLeastShare = 0.8;  // of the usual one
constexpr int kLeastScans = 3;       // 18 innovations against 6 unknowns
constexpr double kStrongM = 0.01;    // a direction that one scan determines so well is heard
constexpr double kLeverM = 10.0;     // of a rotation, to be compared with a way

/// Innovations of a scan in the directions that it determines well.
struct Innovation {
  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 6, 6> directions;  ///< rows, of [position, rotation]
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> r;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> S;  ///< covariance of r
};

/// From what a scan made of the pose and its covariance: it was a measurement of the pose with the
/// information P+^-1 - P-^-1.
Innovation innovation_of(const FilterState& predicted, const FilterState& after) {
  Vector6d unit;
  unit << 1, 1, 1, kLeverM, kLeverM, kLeverM;
  const auto scaled = [&](const FilterState& s) -> Matrix6d {
    return unit.asDiagonal() * s.P.topLeftCorner<6, 6>() * unit.asDiagonal();
  };
  const Matrix6d P = scaled(predicted);
  const Matrix6d P_inverse = P.ldlt().solve(Matrix6d::Identity());
  const Matrix6d told = scaled(after).ldlt().solve(Matrix6d::Identity()) - P_inverse;
  const Vector6d moved = unit.cwiseProduct(after.minus(predicted).head<6>());
  const Vector6d pull = P_inverse * moved;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(0.5 * (told + told.transpose()));
  const Vector6d& information = solver.eigenvalues();
  const auto strong = (information.array() > 1.0 / (kStrongM * kStrongM)).count();
  const auto V = solver.eigenvectors().rightCols(strong);
  const auto noise = information.tail(strong).cwiseInverse();
  Innovation i;
  i.directions = V.transpose() * unit.asDiagonal();
  i.r = V.transpose() * moved + noise.cwiseProduct(V.transpose() * pull);
  i.S = V.transpose() * P * V;
  i.S.diagonal() += noise;
  return i;
}

/// What a scan saw of the pose's errors. Its points were put in place by velocity and rate of the
/// prediction: `age_s` is how long they had been measured on average when it ended.
Eigen::Matrix<double, 6, 6> seen(const Eigen::Matrix<double, 15, 6>& errors, double age_s) {
  Eigen::Matrix<double, 6, 6> pose = errors.topRows<6>();
  pose.topRows<3>() -= age_s * errors.middleRows<3>(FilterState::kV);
  pose.bottomRows<3>() += age_s * errors.middleRows<3>(FilterState::kBg);
  return pose;
}

}  // namespace

void BiasJumpWatch::carry(const FilterState& before, const FilterState& predicted,
                          const Eigen::Vector3d& gravity, double span_s) {
  age_s_ = 0.5 * span_s;
  if (count_ == kOnsets) {
    std::move(onsets_.begin() + 1, onsets_.end(), onsets_.begin());
    --count_;
  }
  Onset& fresh = onsets_[count_++];
  fresh.information.setZero();
  fresh.gradient.setZero();
  fresh.squares = 0;
  fresh.least_share = 1;
  fresh.scans = fresh.jump.age = 0;
  fresh.jump.now.setZero();
  fresh.jump.now.bottomRows<6>().setIdentity();
  fresh.jump.gravity.setZero();
  const Matrix15d F = error_transition(before, predicted, gravity);
  const double dt = to_seconds(predicted.t - before.t);
  for (std::size_t i = 0; i < count_; ++i) {
    BiasJump& jump = onsets_[i].jump;
    ++jump.age;
    jump.before = jump.now;
    jump.now = F * jump.before;
    jump.now.middleRows<3>(FilterState::kP) += 0.5 * dt * dt * jump.gravity;
    jump.now.middleRows<3>(FilterState::kV) += dt * jump.gravity;
  }
}

void BiasJumpWatch::hear(const FilterState& predicted, const FilterState& after, double share) {
  const Innovation i = innovation_of(predicted, after);
  if (i.r.size() == 0) return;
  const auto S = i.S.ldlt();
  const double squares = i.r.dot(S.solve(i.r));
  for (std::size_t k = 0; k < count_; ++k) {
    Onset& onset = onsets_[k];
    const Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 6, 6> J =
        i.directions * seen(onset.jump.now, age_s_);
    onset.information += J.transpose() * S.solve(J);
    onset.gradient += J.transpose() * S.solve(i.r);
    onset.squares += squares;
    onset.least_share = std::min(onset.least_share, share);
    ++onset.scans;
  }
}

void BiasJumpWatch::correct(const Matrix15d& left, const Eigen::Matrix<double, 3, 15>& gain) {
  const Eigen::Matrix<double, 15, 6> gain_pose = (Matrix15d::Identity() - left).leftCols<6>();
  for (std::size_t i = 0; i < count_; ++i) {
    BiasJump& jump = onsets_[i].jump;
    const Eigen::Matrix<double, 15, 6> after = jump.now - gain_pose * seen(jump.now, age_s_);
    jump.gravity += gain * (after - jump.now);
    jump.now = after;
  }
}

void BiasJumpWatch::change_errors(const Matrix15d& change) {
  for (std::size_t i = 0; i < count_; ++i) onsets_[i].jump.now = change * onsets_[i].jump.now;
}

/// The likeliest jump there, given the sizes that jumps have.
BiasJump BiasJumpWatch::fit(const Onset& onset) {
  Matrix6d information = onset.information;
  information.diagonal().head<3>().array() += 1.0 / (kAccelSigma * kAccelSigma);
  information.diagonal().tail<3>().array() += 1.0 / (kGyroSigma * kGyroSigma);
  BiasJump jump = onset.jump;
  jump.P = information.ldlt().solve(Matrix6d::Identity());
  jump.P = (0.5 * (jump.P + jump.P.transpose())).eval();
  jump.size = jump.P * onset.gradient;
  return jump;
}

std::optional<BiasJump> BiasJumpWatch::believed() const {
  const Onset* best = nullptr;
  double most = kLikely;
  for (std::size_t i = 0; i < count_; ++i) {
    const double likely = onsets_[i].gradient.dot(fit(onsets_[i]).size);
    if (likely <= most) continue;
    most = likely;
    best = &onsets_[i];
  }
  if (best == nullptr || best->scans < kLeastScans || best->least_share < kLeastShare ||
      most < kExplained * best->squares) {
    return std::nullopt;
  }
  const BiasJump jump = fit(*best);
  const bool usual = jump.size.head<3>().norm() < kLargest * kAccelSigma &&
                     jump.size.tail<3>().norm() < kLargest * kGyroSigma;
  return usual ? std::optional(jump) : std::nullopt;
}

}  // namespace holdfast::odometry
