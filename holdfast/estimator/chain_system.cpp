#include "holdfast/estimator/chain_system.hpp"

#include <Eigen/Cholesky>
#include <cassert>

namespace holdfast::estimator {

ChainSystem::ChainSystem(int capacity) : node_(capacity), link_(capacity) {}

void ChainSystem::clear(int nodes) {
  assert(nodes >= 1 && nodes <= static_cast<int>(node_.size()));
  nodes_ = nodes;
  cost_ = 0;
  for (int k = 0; k < nodes; ++k) {
    node_[k].H.setZero();
    node_[k].g.setZero();
    link_[k].setZero();
  }
}

bool ChainSystem::eliminate() {
  for (int k = 0; k + 1 < nodes_; ++k) {
    NodeBlock& here = node_[k];
    NodeBlock& next = node_[k + 1];
    Eigen::LLT<Eigen::Ref<Matrix18d>> llt(here.H);
    if (llt.info() != Eigen::Success) return false;
    const auto L = here.H.triangularView<Eigen::Lower>();
    L.solveInPlace(link_[k]);
    L.solveInPlace(here.g);
    next.H.noalias() -= link_[k].transpose() * link_[k];
    next.g.noalias() -= link_[k].transpose() * here.g;
    cost_ -= here.g.squaredNorm();
  }
  return true;
}

void ChainSystem::back_substitute(const Vector18d& last, std::vector<Vector18d>& steps) const {
  steps[nodes_ - 1] = last;
  for (int k = nodes_ - 2; k >= 0; --k) {
    Vector18d& step = steps[k];
    step = -node_[k].g;
    step.noalias() -= link_[k] * steps[k + 1];
    node_[k].H.triangularView<Eigen::Lower>().transpose().solveInPlace(step);
  }
}

}  // namespace holdfast::estimator
