#pragma once

#include <vector>

#include "holdfast/estimator/factors/quadratic.hpp"

namespace holdfast::estimator {

/// Normal equations of a chain of nodes, each linked to its neighbours only: a block tridiagonal
/// system of 18 x 18 blocks, solved by block Cholesky elimination from the oldest node on. What is
/// left on the last node is the marginal of all others (the Schur complement), so the same
/// elimination solves, marginalises, and yields the covariance of the newest node.
/// Nothing is allocated after construction.
class ChainSystem {
 public:
  /// For up to `capacity` nodes.
  explicit ChainSystem(int capacity);

  /// `nodes` nodes without any information.
  void clear(int nodes);
  int nodes() const { return nodes_; }

  NodeBlock& node(int k) { return node_[k]; }
  /// Blocks of nodes k and k + 1.
  PairBlocks pair(int k) { return {node_[k], node_[k + 1], link_[k], cost_}; }
  double& cost() { return cost_; }

  /// Eliminates all nodes but the last, in place; false if a block is not positive definite, which
  /// leaves nothing usable. cost() becomes the least cost over the eliminated nodes.
  bool eliminate();

  /// After eliminate(): the marginal of the last node.
  const NodeBlock& last() const { return node_[nodes_ - 1]; }

  /// After eliminate(): the steps of all nodes that go with the step `last` of the last one, which
  /// are optimal given it. `steps` has nodes() entries.
  void back_substitute(const Vector18d& last, std::vector<Vector18d>& steps) const;

 private:
  int nodes_ = 0;
  double cost_ = 0;
  std::vector<NodeBlock> node_;  ///< after elimination: H = L L^T by its lower half L, g = L^-1 g
  std::vector<Matrix18d> link_;  ///< between k and k + 1; after elimination: L^-1 H_ij
};

}  // namespace holdfast::estimator
