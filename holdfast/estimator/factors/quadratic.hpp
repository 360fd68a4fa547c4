#pragma once

#include "holdfast/estimator/node_state.hpp"

namespace holdfast::estimator {

/// A linearised cost of one node: cost(x [+] d) ~ cost + 2 g.d + d.H d, as in
/// registration::NormalEquations: costs are sums of squared whitened residuals, without a half.
struct NodeBlock {
  Matrix18d H = Matrix18d::Zero();
  Vector18d g = Vector18d::Zero();
};

/// Where a factor between two neighbouring nodes i and j adds its normal equations.
struct PairBlocks {
  NodeBlock& i;
  NodeBlock& j;
  Matrix18d& H_ij;
  double& cost;
};

/// Adds a residual with its Jacobians by the first `A` unknowns of i and the first `B` of j. All
/// are whitened: the covariance of the residual is the identity.
template <int Rows, int A, int B>
void add_whitened(const Eigen::Matrix<double, Rows, 1>& r, const Eigen::Matrix<double, Rows, A>& Ji,
                  const Eigen::Matrix<double, Rows, B>& Jj, const PairBlocks& out) {
  out.i.H.topLeftCorner<A, A>() += Ji.transpose() * Ji;
  out.j.H.topLeftCorner<B, B>() += Jj.transpose() * Jj;
  out.H_ij.topLeftCorner<A, B>() += Ji.transpose() * Jj;
  out.i.g.head<A>() += Ji.transpose() * r;
  out.j.g.head<B>() += Jj.transpose() * r;
  out.cost += r.squaredNorm();
}

}  // namespace holdfast::estimator
