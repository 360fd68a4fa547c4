#include "holdfast/estimator/chain_system.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "tests/estimator/scene.hpp"

namespace holdfast::estimator {
namespace {

constexpr int kNodes = 6;
constexpr int kSize = 18 * kNodes;

/// A chain with random information, and the same as one dense system.
class AChain : public ::testing::Test {
 protected:
  void SetUp() override { fill(kNodes); }

  void fill(int nodes) {
    RandomStream random(1, "chain");
    system.clear(nodes);
    H.setZero();
    g.setZero();
    for (int k = 0; k + 1 < nodes; ++k) {
      Eigen::Matrix<double, 40, 36> J;
      Eigen::Matrix<double, 40, 1> r;
      for (int i = 0; i < J.size(); ++i) J(i) = random.normal();
      for (int i = 0; i < 40; ++i) r[i] = random.normal();
      add_whitened<40, 18, 18>(r, J.leftCols<18>(), J.rightCols<18>(), system.pair(k));
      H.block<36, 36>(18 * k, 18 * k) += J.transpose() * J;
      g.segment<36>(18 * k) += J.transpose() * r;
      cost += r.squaredNorm();
    }
  }

  ChainSystem system{kNodes};
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(kSize, kSize);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(kSize);
  double cost = 0;
};

/// Rounding of a dense solve with such a matrix.
double solve_tolerance(const Eigen::MatrixXd& H) {
  return tolerances::kRounding * H.norm() * H.inverse().norm();
}

TEST_F(AChain, IsSolvedLikeTheDenseSystem) {
  const Eigen::VectorXd expected = -H.llt().solve(g);
  ASSERT_TRUE(system.eliminate());
  std::vector<Vector18d> steps(kNodes);
  system.back_substitute(-system.last().H.llt().solve(system.last().g), steps);
  for (int k = 0; k < kNodes; ++k) {
    EXPECT_LT((steps[k] - expected.segment<18>(18 * k)).norm(),
              solve_tolerance(H) * expected.norm());
  }
}

TEST_F(AChain, LeavesTheCovarianceOfItsLastNode) {
  const Matrix18d expected = H.inverse().bottomRightCorner<18, 18>();
  ASSERT_TRUE(system.eliminate());
  EXPECT_LT((system.last().H.inverse() - expected).norm(), solve_tolerance(H) * expected.norm());
}

TEST_F(AChain, LeavesTheLeastCost) {
  const double expected = cost - g.dot(H.llt().solve(g));
  ASSERT_TRUE(system.eliminate());
  const NodeBlock& last = system.last();
  EXPECT_NEAR(system.cost() - last.g.dot(last.H.llt().solve(last.g)), expected,
              solve_tolerance(H) * cost);
}

TEST_F(AChain, MarginalisedNodeByNodeIsTheSame) {
  NodeBlock marginal;
  for (int k = 0; k + 1 < kNodes; ++k) {
    ChainSystem pair(2);
    pair.clear(2);
    pair.node(0).H = marginal.H + H.block<18, 18>(18 * k, 18 * k);
    pair.node(0).g = marginal.g + g.segment<18>(18 * k);
    pair.pair(0).H_ij = H.block<18, 18>(18 * k, 18 * (k + 1));
    ASSERT_TRUE(pair.eliminate());
    marginal = pair.last();
  }
  marginal.H += H.bottomRightCorner<18, 18>();
  marginal.g += g.tail<18>();
  ASSERT_TRUE(system.eliminate());
  EXPECT_LT((marginal.H - system.last().H).norm(), solve_tolerance(H) * marginal.H.norm());
  EXPECT_LT((marginal.g - system.last().g).norm(), solve_tolerance(H) * marginal.g.norm());
}

TEST_F(AChain, WithoutInformationIsRefused) {
  system.clear(2);
  EXPECT_FALSE(system.eliminate());
}

}  // namespace
}  // namespace holdfast::estimator
