#pragma once

#include <optional>

#include "holdfast/estimator/factors/quadratic.hpp"
#include "holdfast/estimator/preintegration.hpp"

namespace holdfast::estimator {

/// How far what is nearly constant may move between two nodes, one sigma of each axis.
struct WalkSigmas {
  double accel_bias = 0;  ///< m/s^2
  double gyro_bias = 0;   ///< rad/s
  double gravity = 0;     ///< m/s^2
};

/// The readings of the IMU between two nodes as a constraint of both (Forster et al., TRO 2017,
/// eqs. 37 and 45; article 3.3.2, r_imu): nine residuals of motion with gravity and velocity, and
/// the random walks of the biases and of gravity.
class ImuFactor {
 public:
  using Jacobian18 = Eigen::Matrix<double, 9, 18>;
  using Jacobian9 = Eigen::Matrix<double, 9, 9>;

  /// Residual [position, rotation, velocity] in the body frame at i, and its derivatives by all of
  /// node i and by [p, R, v] of node j (of whose biases it does not depend).
  struct Linearised {
    Vector9d residual;
    Jacobian18 J_i;
    Jacobian9 J_j;
  };

  /// To be called when `preintegration` was integrated anew.
  void set(const WalkSigmas& walk);

  /// Instead of the covariance of the motion the weight of the printed cost, on squared norms
  /// (article 3.3.2: w_imu = 1.2).
  void set_weight(double weight);

  /// Re-integrates if the bias of `i` has moved too far from that of the integration.
  void rebase(const NodeState& i);

  Linearised linearise(const NodeState& i, const NodeState& j) const;
  void add_to(const NodeState& i, const NodeState& j, const PairBlocks& out) const;

  const WalkSigmas& walk() const { return walk_; }
  void set_walk(const WalkSigmas& walk) { walk_ = walk; }

  Preintegration preintegration;

 private:
  void whiten_by_covariance();

  WalkSigmas walk_;
  std::optional<double> weight_;
  Matrix9d whitening_ = Matrix9d::Identity();  ///< W with W cov W^T = I
};

}  // namespace holdfast::estimator
