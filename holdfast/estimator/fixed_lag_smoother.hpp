#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "holdfast/estimator/chain_system.hpp"
#include "holdfast/estimator/factors/between_factor.hpp"
#include "holdfast/estimator/factors/imu_factor.hpp"
#include "holdfast/estimator/factors/map_factor.hpp"
#include "holdfast/estimator/factors/prior_factor.hpp"
#include "holdfast/estimator/smoother_options.hpp"

namespace holdfast::estimator {

/// Estimate of the last few nodes from IMU, prior map and odometry (article 3.3.2): a chain of
/// nodes in which each is linked to the next. The newest node's map residual is linearised anew in
/// every iteration; older nodes keep their last quadratic. The oldest node is marginalised when the
/// window is full, at the current estimate. Same calls, same bits. No allocation after the first
/// `window` scans but for longer IMU segments.
class FixedLagSmoother {
 public:
  /// The map residual of the newest node at a state; empty where the scan tells nothing.
  using Measure = std::function<std::optional<MapFactor>(const NodeState&)>;

  explicit FixedLagSmoother(const SmootherConfig& config);

  /// One node with a Gaussian prior.
  void reset(const NodeState& state, const Matrix18d& covariance);

  /// Appends a node at the end of `imu`, which begins at newest().t, predicted by it; optionally
  /// linked by an odometry too. Where readings are held for filter::kLongestHold or more, the
  /// biases of the new node are let go as far as the motion wanders from the held reading.
  void push(const preprocess::ImuSegment& imu,
            const std::optional<BetweenFactor>& between = std::nullopt);

  /// Links the two newest nodes by an odometry, if nothing did.
  void link_newest(const BetweenFactor& between) { slot(size_ - 1).between = between; }

  /// Moves the newest node: a better start than the prediction, from a registration.
  void set_guess(const NodeState& state) { slot(size_ - 1).x = state; }

  OptimiseReport optimise(const Measure& measure, const OptimiseOptions& options = {});

  int size() const { return size_; }
  const NodeState& node(int k) const { return slot(k).x; }  ///< 0 is the oldest
  const NodeState& newest() const { return node(size_ - 1); }

  /// Covariance of the newest node with everything, and without its map residual: its prediction.
  /// Both after optimise(); 18 x 18.
  Matrix18d covariance_of_newest() const;
  Matrix18d covariance_of_prediction() const;

  /// How well the last optimise() agreed with its prediction: squared length of the correction of
  /// [p, R] in terms of its expected covariance, chi-square with 6 degrees of freedom where the
  /// scene constrains them all.
  double innovation(const OptimiseReport& report) const;

  /// By how much the cost would fall if the biases had jumped during the interval `age` intervals
  /// before the newest one: the walks into and out of the node at which it began are let go (a jump
  /// inside of an interval leaves it a bias of its own). Twice a log likelihood ratio: without a
  /// jump it is chi-square with up to 12 degrees of freedom, so that 40 comes by chance once in
  /// 10^4. 0 where the window holds no such interval. Costs two eliminations of the linearised
  /// chain.
  double bias_jump_gain(int age = 0);

  /// Lets the biases jump there; the next optimise() uses it.
  void allow_bias_jump(int age = 0);

 private:
  struct Slot {
    NodeState x;
    bool has_map = false;
    MapFactor map;
    ImuFactor imu;  ///< from the slot before
    std::optional<BetweenFactor> between;
  };

  Slot& slot(int k) { return slots_[(head_ + k) % slots_.size()]; }
  const Slot& slot(int k) const { return slots_[(head_ + k) % slots_.size()]; }

  void marginalise_oldest();
  void add_pair(int k, ChainSystem& system);
  void linearise(bool with_newest_map);
  void settle_newest(const Measure& measure, const OptimiseOptions& options,
                     OptimiseReport& report);
  void step_newest(const NodeState& linearised_at, OptimiseReport& report);
  double move_older(const NodeState& linearised_at);
  double least_cost();
  WalkSigmas walk_over(const preprocess::ImuSegment& imu, double seconds) const;
  bool jump_is_inside(int age) const { return age >= 0 && size_ - 3 - age >= 0; }
  WalkSigmas loosened(WalkSigmas walk) const;

  SmootherConfig config_;
  std::vector<Slot> slots_;
  int head_ = 0;
  int size_ = 0;
  PriorFactor prior_;
  ChainSystem system_;
  ChainSystem pair_system_;
  std::vector<Vector18d> steps_;
  Matrix18d information_ = Matrix18d::Identity();
  Matrix18d predicted_information_ = Matrix18d::Identity();
};

}  // namespace holdfast::estimator
