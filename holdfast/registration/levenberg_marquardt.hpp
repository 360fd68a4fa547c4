#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>

#include "holdfast/core/se3.hpp"

namespace holdfast::registration {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// A cost at a pose and its second-order model: cost(x + d) ~ cost + 2 g.d + d.H d, for a step
/// d = [translation added in the map frame, rotation vector of a perturbation on the right].
struct PoseModel {
  double cost = 0;
  Vector6d g = Vector6d::Zero();
  Matrix6d H = Matrix6d::Zero();

  /// Adds weight * residual^2 with the residual's row of the Jacobian.
  void add(double residual, const Vector6d& jacobian, double weight) {
    cost += weight * residual * residual;
    g += weight * residual * jacobian;
    H.noalias() += weight * jacobian * jacobian.transpose();
  }
};

struct LevenbergMarquardtOptions {
  int max_iterations = 30;
  double converged_m = 1e-6;    ///< a step below both limits ends the search
  double converged_rad = 1e-6;  ///< (article 3.4.2: LM to 1e-6)
  double first_damping = 1e-4;  ///< as a share of the diagonal of H
};

struct LevenbergMarquardtResult {
  SE3 pose;
  double cost = 0;
  int iterations = 0;  ///< times that the model was asked for
  bool converged = false;
};

/// The pose moved by a step.
inline SE3 moved(const SE3& pose, const Vector6d& step) {
  return {(pose.rotation * so3::exp(step.tail<3>())).normalized(),
          pose.translation + step.head<3>()};
}

/// Minimises a cost over SE(3) by Levenberg-Marquardt (article 3.2.2): a step that lowers the cost
/// is taken and the damping falls, any other is undone and the damping rises. `model(pose)` returns
/// the PoseModel at a pose. Directions without information (zero rows of H) are not moved along.
template <class Model>
LevenbergMarquardtResult minimise_by_levenberg_marquardt(
    const SE3& start, const Model& model, const LevenbergMarquardtOptions& options = {}) {
  constexpr double kLeastDiagonal = 1e-9;  // keeps the system regular where nothing is known
  constexpr double kMostDamping = 1e12;
  LevenbergMarquardtResult result{start, 0, 1, false};
  PoseModel here = model(start);
  result.cost = here.cost;
  double damping = options.first_damping;
  while (result.iterations < options.max_iterations && damping < kMostDamping) {
    Matrix6d damped = here.H;
    damped.diagonal() += damping * here.H.diagonal() +
                         Vector6d::Constant(kLeastDiagonal * (1.0 + here.H.diagonal().maxCoeff()));
    const Vector6d step = -damped.ldlt().solve(here.g);
    const SE3 next_pose = moved(result.pose, step);
    const PoseModel next = model(next_pose);
    ++result.iterations;
    const bool small = step.head<3>().norm() < options.converged_m &&
                       step.tail<3>().norm() < options.converged_rad;
    if (next.cost <= here.cost) {
      result.pose = next_pose;
      result.cost = next.cost;
      here = next;
      damping = std::max(0.1 * damping, 1e-12);
    } else {
      damping *= 10.0;
    }
    if (small) {
      result.converged = true;
      break;
    }
  }
  return result;
}

}  // namespace holdfast::registration
