#pragma once

#include "holdfast/estimator/factors/quadratic.hpp"

namespace holdfast::estimator {

/// Motion between two nodes as an odometry tells it, in the frame of the first:
/// T_prev_cur = T_odom_prev^-1 * T_odom_cur.
struct OdometryIncrement {
  SE3 T_prev_cur;
  Matrix6d covariance = Matrix6d::Identity();  ///< [position in prev, rotation on the right]
};

/// Loss rho(k^2) of a residual k sigmas long; it multiplies the normal equations by its slope.
enum class RobustLoss {
  kNone,          ///< k^2
  kHuber,         ///< k^2 up to k = c, then 2 c k - c^2
  kGemanMcClure,  ///< c^2 k^2 / (c^2 + k^2), as for the points of a scan
};

/// Article 3.3.1, r_odom, as a constraint of two nodes: of their own increment, T_i^-1 T_j, while
/// the printed one, T_j T_i^-1, has a lever arm to the map's origin (`printed`).
class BetweenFactor {
 public:
  using Jacobian = Eigen::Matrix<double, 6, 6>;

  /// Residual [position, rotation] and its derivatives by [p, R] of both nodes.
  struct Linearised {
    Vector6d residual;
    Jacobian J_i, J_j;
  };

  /// Weights of the printed cost on squared norms (article 3.3.2).
  struct PrintedWeights {
    double agreeing = 0.5;
    double differing = 0.1;
    double largest_m = 0.3;
    double largest_rad = 5 * 0.017453292519943295;
  };

  BetweenFactor() = default;
  BetweenFactor(const OdometryIncrement& increment, RobustLoss loss, double scale);

  /// The article's residual log(dT_map dT_lio^-1) with dT = T_j T_i^-1, and its weights;
  /// `T_odom_i`, `T_odom_j` are poses of the odometry. Its translation is left as it is instead of
  /// multiplied by V^-1, which differs in second order.
  static BetweenFactor printed(const SE3& T_odom_i, const SE3& T_odom_j,
                               const PrintedWeights& weights);

  Linearised linearise(const NodeState& i, const NodeState& j) const;
  void add_to(const NodeState& i, const NodeState& j, const PairBlocks& out) const;

  /// Mahalanobis distance of the residual, squared and without the loss: chi-square with 6 degrees
  /// of freedom.
  double squared_distance(const NodeState& i, const NodeState& j) const;

 private:
  Linearised linearise_in_body(const NodeState& i, const NodeState& j) const;
  Linearised linearise_in_world(const NodeState& i, const NodeState& j) const;

  SE3 measured_;
  Matrix6d whitening_ = Matrix6d::Identity();
  RobustLoss loss_ = RobustLoss::kNone;
  double scale_ = 3.0;
  bool is_printed_ = false;
  PrintedWeights weights_;
};

}  // namespace holdfast::estimator
