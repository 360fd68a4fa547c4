#include "holdfast/estimator/fixed_lag_smoother.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace holdfast::estimator {
namespace {

Matrix18d inverse(const Matrix18d& information) {
  const Matrix18d P = information.llt().solve(Matrix18d::Identity());
  return 0.5 * (P + P.transpose());
}

}  // namespace

FixedLagSmoother::FixedLagSmoother(const SmootherConfig& config)
    : config_(config),
      slots_(config.window),
      system_(config.window),
      pair_system_(2),
      steps_(config.window) {
  assert(config.window >= 3);
}

void FixedLagSmoother::reset(const NodeState& state, const Matrix18d& covariance) {
  head_ = 0;
  size_ = 1;
  slots_[0].x = state;
  slots_[0].has_map = false;
  prior_ = PriorFactor(state, covariance);
  linearise(false);
  information_ = predicted_information_ = system_.last().H;
}

WalkSigmas FixedLagSmoother::walk_over(const preprocess::ImuSegment& imu, double seconds) const {
  const Preintegration::Noise& n = config_.noise;
  const double root = std::sqrt(seconds);
  WalkSigmas walk{n.imu.accel_bias_walk * root, n.imu.gyro_bias_walk * root,
                  config_.gravity_walk * root};
  if (imu.held_ns < filter::kLongestHold) return walk;
  // An Ornstein-Uhlenbeck process begins as a random walk of density sigma sqrt(2 / tau).
  const double held = std::sqrt(2 * to_seconds(imu.held_ns) / n.unmeasured.time_constant_s);
  walk.accel_bias = std::max(walk.accel_bias, n.unmeasured.accel_sigma_m_s2 * held);
  walk.gyro_bias = std::max(walk.gyro_bias, n.unmeasured.gyro_sigma_rad_s * held);
  return walk;
}

void FixedLagSmoother::push(const preprocess::ImuSegment& imu,
                            const std::optional<BetweenFactor>& between) {
  assert(size_ >= 1 && !imu.samples.empty());
  if (size_ == config_.window) marginalise_oldest();
  const NodeState& last = newest();
  Slot& next = slot(size_);
  next.has_map = false;
  next.between = between;
  next.imu.preintegration.integrate(imu, last.accel_bias, last.gyro_bias, config_.noise);
  next.imu.set(walk_over(imu, next.imu.preintegration.seconds()));
  if (config_.imu_weight > 0) next.imu.set_weight(config_.imu_weight);
  next.x = next.imu.preintegration.predict(last);
  ++size_;
}

/// Adds what links nodes k and k + 1, and what is known of k alone.
void FixedLagSmoother::add_pair(int k, ChainSystem& system) {
  const int at = &system == &pair_system_ ? 0 : k;
  Slot& here = slot(k);
  Slot& next = slot(k + 1);
  if (k == 0) prior_.add_to(here.x, system.node(at), system.cost());
  if (here.has_map) here.map.add_to(here.x, system.node(at), system.cost());
  next.imu.rebase(here.x);
  const PairBlocks blocks = system.pair(at);
  next.imu.add_to(here.x, next.x, blocks);
  if (next.between) next.between->add_to(here.x, next.x, blocks);
}

/// The Schur complement on the second node of all that the first takes part in.
void FixedLagSmoother::marginalise_oldest() {
  pair_system_.clear(2);
  add_pair(0, pair_system_);
  const bool solved = pair_system_.eliminate();
  assert(solved);
  (void)solved;
  prior_ = PriorFactor(node(1), pair_system_.last(), pair_system_.cost());
  head_ = static_cast<int>((head_ + 1) % slots_.size());
  --size_;
}

/// Normal equations of everything at the current estimate.
void FixedLagSmoother::linearise(bool with_newest_map) {
  system_.clear(size_);
  for (int k = 0; k + 1 < size_; ++k) add_pair(k, system_);
  Slot& last = slot(size_ - 1);
  NodeBlock& block = system_.node(size_ - 1);
  if (size_ == 1) prior_.add_to(last.x, block, system_.cost());
  if (with_newest_map && last.has_map) last.map.add_to(last.x, block, system_.cost());
}

OptimiseReport FixedLagSmoother::optimise(const Measure& measure, const OptimiseOptions& options) {
  OptimiseReport report;
  const NodeState predicted = newest();
  slot(size_ - 1).has_map = false;
  while (report.linearisations < options.max_linearisations) {
    linearise(false);
    report.solved = system_.eliminate();
    if (!report.solved) break;
    if (report.linearisations++ == 0) predicted_information_ = system_.last().H;
    const NodeState linearised_at = newest();
    settle_newest(measure, options, report);
    if (!report.solved || move_older(linearised_at) <= options.relinearise_rad) break;
  }
  report.map_used = slot(size_ - 1).has_map;
  report.correction = newest().minus(predicted);
  return report;
}

/// Iterates on the newest node alone, given the marginal of all others. A map residual from an
/// earlier linearisation of the chain is good until the newest node moves again.
void FixedLagSmoother::settle_newest(const Measure& measure, const OptimiseOptions& options,
                                     OptimiseReport& report) {
  Slot& last = slot(size_ - 1);
  const NodeState linearised_at = last.x;
  for (bool stale = report.measurements == 0;; stale = true) {
    if (stale) {
      const std::optional<MapFactor> map = measure(last.x);
      ++report.measurements;
      last.has_map = map.has_value();
      if (map) last.map = *map;
    }
    const NodeState before = last.x;
    step_newest(linearised_at, report);
    if (!report.solved) return;
    const Vector18d moved = last.x.minus(before);
    report.converged = moved.segment<3>(NodeState::kP).norm() < options.converged_m &&
                       moved.segment<3>(NodeState::kR).norm() < options.converged_rad;
    if (!last.has_map) report.converged = true;
    const bool enough = report.converged && report.measurements >= options.min_measurements;
    if (!last.has_map || enough || report.measurements >= options.max_measurements) return;
  }
}

/// One Gauss-Newton step of the newest node on its map residual and the marginal of the chain.
void FixedLagSmoother::step_newest(const NodeState& linearised_at, OptimiseReport& report) {
  Slot& last = slot(size_ - 1);
  NodeBlock block;
  report.cost = system_.cost();
  PriorFactor(linearised_at, system_.last(), 0).add_to(last.x, block, report.cost);
  if (last.has_map) last.map.add_to(last.x, block, report.cost);
  const Eigen::LLT<Matrix18d> llt(block.H);
  report.solved = llt.info() == Eigen::Success;
  if (!report.solved) {
    last.has_map = false;  // the only thing here that can be at fault
    return;
  }
  information_ = block.H;
  const Vector18d step = -llt.solve(block.g);
  report.cost += step.dot(block.g);
  last.x.add(step);
}

/// The older nodes follow the newest; returns the largest turn of any.
double FixedLagSmoother::move_older(const NodeState& linearised_at) {
  system_.back_substitute(newest().minus(linearised_at), steps_);
  double turn = 0;
  for (int k = 0; k < size_; ++k) {
    turn = std::max(turn, steps_[k].segment<3>(NodeState::kR).norm());
    if (k + 1 < size_) slot(k).x.add(steps_[k]);
  }
  return turn;
}

Matrix18d FixedLagSmoother::covariance_of_newest() const { return inverse(information_); }

Matrix18d FixedLagSmoother::covariance_of_prediction() const {
  return inverse(predicted_information_);
}

double FixedLagSmoother::innovation(const OptimiseReport& report) const {
  // The correction of a Kalman update has the covariance P- minus P+; directions in which the scan
  // tells next to nothing have neither, and are kept out by a small share of P-.
  constexpr double kShare = 1e-3;
  const Matrix6d before = covariance_of_prediction().topLeftCorner<6, 6>();
  const Matrix6d after = covariance_of_newest().topLeftCorner<6, 6>();
  const Matrix6d S = (1 + kShare) * before - after;
  const Vector6d d = report.correction.head<6>();
  return d.dot(S.ldlt().solve(d));
}

/// The least cost of the linearised chain over all nodes.
double FixedLagSmoother::least_cost() {
  linearise(true);
  if (!system_.eliminate()) return std::numeric_limits<double>::infinity();
  const NodeBlock& last = system_.last();
  return system_.cost() - last.g.dot(last.H.llt().solve(last.g));
}

WalkSigmas FixedLagSmoother::loosened(WalkSigmas walk) const {
  walk.accel_bias = std::max(walk.accel_bias, config_.accel_jump_m_s2);
  walk.gyro_bias = std::max(walk.gyro_bias, config_.gyro_jump_rad_s);
  return walk;
}

void FixedLagSmoother::allow_bias_jump(int age) {
  if (!jump_is_inside(age)) return;
  for (const int k : {size_ - 2 - age, size_ - 1 - age}) {
    slot(k).imu.set_walk(loosened(slot(k).imu.walk()));
  }
}

double FixedLagSmoother::bias_jump_gain(int age) {
  if (!jump_is_inside(age)) return 0;
  ImuFactor& into = slot(size_ - 2 - age).imu;
  ImuFactor& out_of = slot(size_ - 1 - age).imu;
  const WalkSigmas walk_into = into.walk();
  const WalkSigmas walk_out = out_of.walk();
  const double without = least_cost();
  allow_bias_jump(age);
  const double with = least_cost();
  into.set_walk(walk_into);
  out_of.set_walk(walk_out);
  return without - with;
}

}  // namespace holdfast::estimator
