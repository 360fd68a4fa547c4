#include <Eigen/Eigenvalues>

#include "holdfast/estimator/factors/between_factor.hpp"
#include "holdfast/estimator/factors/imu_factor.hpp"
#include "holdfast/estimator/factors/map_factor.hpp"
#include "holdfast/estimator/factors/prior_factor.hpp"
#include "tests/estimator/scene.hpp"

namespace holdfast::estimator {
namespace {

using Eigen::Vector3d;
using testing::differences;

/// Two nodes: the second is where the readings lead the first, plus an error of a given size.
class TwoNodes : public testing::AtRotation {
 protected:
  void SetUp() override { set(0.05); }

  void set(double error) {
    RandomStream random(2, "errors");
    i = testing::state_at(rotation());
    factor.preintegration.integrate(testing::wild(9), i.accel_bias, i.gyro_bias, {});
    factor.set({1e-2, 1e-3, 1e-2});
    i.accel_bias += testing::random_vector(random, 0.05);
    i.gyro_bias += testing::random_vector(random, 0.005);
    j = factor.preintegration.predict(i);
    j.add(testing::random_tangent(random, error));
  }

  NodeState i, j;
  ImuFactor factor;
};

/// Blocks that start at zero.
struct Blocks {
  NodeBlock i, j;
  Matrix18d H_ij = Matrix18d::Zero();
  double cost = 0;
  PairBlocks pair() { return {i, j, H_ij, cost}; }
};

template <class Factor>
double cost_of(const Factor& factor, const NodeState& i, const NodeState& j) {
  Blocks blocks;
  factor.add_to(i, j, blocks.pair());
  return blocks.cost;
}

/// Gradients of a factor against differences of its cost, whose third derivative is that of a
/// quadratic in a curved chart, and `third` of a robust loss.
template <class Factor>
void expect_derivatives_of_cost(const Factor& factor, const NodeState& i, const NodeState& j,
                                double third = 0) {
  Blocks blocks;
  factor.add_to(i, j, blocks.pair());
  const auto g_i = differences<1>(i, [&](const NodeState& x) {
    return Eigen::Matrix<double, 1, 1>(0.5 * cost_of(factor, x, j));
  });
  const auto g_j = differences<1>(j, [&](const NodeState& x) {
    return Eigen::Matrix<double, 1, 1>(0.5 * cost_of(factor, i, x));
  });
  const double rounding = blocks.cost * 100 * tolerances::kRounding;
  third += 3 * (blocks.i.H.norm() + blocks.j.H.norm());
  const double tolerance = tolerances::difference_error(third, rounding);
  EXPECT_LT((g_i.transpose() - blocks.i.g).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LT((g_j.transpose() - blocks.j.g).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_GT(blocks.i.g.norm(), 100 * tolerance);
}

TEST_P(TwoNodes, ImuJacobiansAreThoseOfDifferences) {
  for (const double error : {0.0, 0.05, 0.5}) {
    set(error);
    const auto l = factor.linearise(i, j);
    const auto J_i =
        differences<9>(i, [&](const NodeState& x) { return factor.linearise(x, j).residual; });
    const auto J_j =
        differences<9>(j, [&](const NodeState& x) { return factor.linearise(i, x).residual; });
    // Positions of 10 m.
    const double tolerance = tolerances::difference_error(10, 10 * tolerances::kRounding);
    EXPECT_LT((J_i - l.J_i).cwiseAbs().maxCoeff(), tolerance) << error;
    EXPECT_LT((J_j.leftCols<9>() - l.J_j).cwiseAbs().maxCoeff(), tolerance) << error;
    EXPECT_LT(J_j.rightCols<9>().cwiseAbs().maxCoeff(), tolerance) << error;
  }
}

TEST_P(TwoNodes, ImuResidualIsZeroWhereTheReadingsLead) {
  set(0.0);
  EXPECT_LT(factor.linearise(i, j).residual.norm(), 100 * tolerances::kRounding);
}

TEST_P(TwoNodes, ImuGradientIsHalfTheDerivativeOfTheCost) {
  expect_derivatives_of_cost(factor, i, j);
  factor.set_weight(1.2);
  expect_derivatives_of_cost(factor, i, j);
}

TEST_P(TwoNodes, ImuCostHasTheWeightOfThePrintOnSquaredNorms) {
  factor.set({1e6, 1e6, 1e6});
  factor.set_weight(1.2);
  EXPECT_NEAR(cost_of(factor, i, j), 1.2 * factor.linearise(i, j).residual.squaredNorm(), 1e-10);
}

Matrix6d some_covariance() {
  RandomStream random(3, "covariance");
  Matrix6d A;
  for (int k = 0; k < 36; ++k) A(k) = random.normal(0, 0.01);
  return A * A.transpose() + 1e-4 * Matrix6d::Identity();
}

BetweenFactor between(const NodeState& i, const NodeState& j, double error, RobustLoss loss) {
  NodeState other = j;
  RandomStream random(4, "odometry");
  other.add(testing::random_tangent(random, error));
  const SE3 increment = i.T_map_body.inverse() * other.T_map_body;
  return {{increment, some_covariance()}, loss, 3.0};
}

TEST_P(TwoNodes, BetweenJacobiansAreThoseOfDifferences) {
  const SE3 T_odom = {so3::exp({0, 0, 1}), {3, 4, 5}};
  for (const double error : {0.0, 0.05, 0.5}) {
    RandomStream random(4, "odometry");
    NodeState other = j;
    other.add(testing::random_tangent(random, error));
    for (const BetweenFactor& f :
         {between(i, j, error, RobustLoss::kNone),
          BetweenFactor::printed(T_odom, T_odom * i.T_map_body.inverse() * other.T_map_body, {})}) {
      const auto l = f.linearise(i, j);
      const auto J_i =
          differences<6>(i, [&](const NodeState& x) { return f.linearise(x, j).residual; });
      const auto J_j =
          differences<6>(j, [&](const NodeState& x) { return f.linearise(i, x).residual; });
      const double tolerance = tolerances::difference_error(10, 20 * tolerances::kRounding);
      EXPECT_LT((J_i.leftCols<6>() - l.J_i).cwiseAbs().maxCoeff(), tolerance) << error;
      EXPECT_LT((J_j.leftCols<6>() - l.J_j).cwiseAbs().maxCoeff(), tolerance) << error;
      EXPECT_LT(J_i.rightCols<12>().norm() + J_j.rightCols<12>().norm(), tolerance) << error;
    }
  }
}

TEST_P(TwoNodes, BetweenGradientIsHalfTheDerivativeOfTheRobustCost) {
  for (const auto loss : {RobustLoss::kNone, RobustLoss::kHuber, RobustLoss::kGemanMcClure}) {
    for (const double error : {0.003, 0.05}) {
      // A loss of scale c bends within c sigmas.
      Blocks plain;
      between(i, j, error, RobustLoss::kNone).add_to(i, j, plain.pair());
      const double third = std::pow(plain.i.H.norm(), 1.5) / 3.0;
      expect_derivatives_of_cost(between(i, j, error, loss), i, j, third);
    }
  }
}

TEST_P(TwoNodes, BetweenResidualIsZeroForTheMotionItself) {
  const auto f = between(i, j, 0.0, RobustLoss::kNone);
  EXPECT_LT(f.linearise(i, j).residual.norm(), 100 * tolerances::kRounding);
  // Printed: the poses of the odometry are those of the map, or else there is a lever arm.
  const auto p = BetweenFactor::printed(i.T_map_body, j.T_map_body, {});
  EXPECT_LT(p.linearise(i, j).residual.norm(), 100 * tolerances::kRounding);
}

TEST_P(TwoNodes, FarOutliersOfTheOdometryHardlyPull) {
  const auto plain = between(i, j, 1.0, RobustLoss::kNone);
  const auto huber = between(i, j, 1.0, RobustLoss::kHuber);
  const auto redescending = between(i, j, 1.0, RobustLoss::kGemanMcClure);
  const double k = std::sqrt(plain.squared_distance(i, j));
  ASSERT_GT(k, 30);
  EXPECT_NEAR(cost_of(huber, i, j) / (2 * 3 * k - 9), 1, 1e-12);
  EXPECT_LT(cost_of(redescending, i, j), 9);
  EXPECT_NEAR(cost_of(plain, i, j) / (k * k), 1, 1e-12);
}

TEST_P(TwoNodes, ThePrintsOdometryWeighsLessWhereItDiffers) {
  const BetweenFactor::PrintedWeights weights;
  for (const double turn : {4.9, 5.1}) {
    const double rad = turn * std::numbers::pi / 180;
    const SE3 wrong{so3::exp({0, 0, rad}), {0, 0, 0}};
    NodeState a, b;
    const auto f = BetweenFactor::printed(a.T_map_body, wrong, weights);
    EXPECT_NEAR(cost_of(f, a, b), (turn < 5 ? 0.5 : 0.1) * rad * rad, 1e-12);
  }
  for (const double metres : {0.29, 0.31}) {
    NodeState a, b;
    const auto f = BetweenFactor::printed({}, {Eigen::Quaterniond::Identity(), {metres, 0, 0}}, {});
    EXPECT_NEAR(cost_of(f, a, b), (metres < 0.3 ? 0.5 : 0.1) * metres * metres, 1e-12);
  }
}

registration::NormalEquations some_map() {
  RandomStream random(5, "map");
  Matrix9d A;
  for (int k = 0; k < 81; ++k) A(k) = random.normal();
  registration::NormalEquations e;
  e.H = A * A.transpose();
  for (int k = 0; k < 9; ++k) e.g[k] = random.normal();
  e.cost = 7;
  return e;
}

template <class Factor>
double cost_of(const Factor& factor, const NodeState& x) {
  NodeBlock block;
  double cost = 0;
  factor.add_to(x, block, cost);
  return cost;
}

template <class Factor>
void expect_gradient_of_cost(const Factor& factor, const NodeState& x) {
  NodeBlock block;
  double cost = 0;
  factor.add_to(x, block, cost);
  const auto g = differences<1>(
      x, [&](const NodeState& y) { return Eigen::Matrix<double, 1, 1>(0.5 * cost_of(factor, y)); });
  const double tolerance =
      tolerances::difference_error(3 * block.H.norm(), 100 * cost * tolerances::kRounding);
  EXPECT_LT((g.transpose() - block.g).cwiseAbs().maxCoeff(), tolerance);
}

TEST_P(TwoNodes, MapFactorIsTheQuadraticWhereItWasLinearised) {
  const auto e = some_map();
  NodeBlock block;
  double cost = 0;
  MapFactor(e, i).add_to(i, block, cost);
  const double tolerance = tolerances::kRounding * e.H.norm();
  EXPECT_LT((block.H.topLeftCorner<9, 9>() - e.H).norm(), tolerance);
  EXPECT_LT((block.g.head<9>() - e.g).norm(), tolerance);
  EXPECT_EQ(block.H.bottomRows<9>().norm() + block.g.tail<9>().norm(), 0);
  EXPECT_NEAR(cost, 7, tolerance);
}

TEST_P(TwoNodes, MapFactorHasItsGradientElsewhereToo) {
  NodeState x = i;
  RandomStream random(6, "elsewhere");
  x.add(testing::random_tangent(random, 0.2));
  expect_gradient_of_cost(MapFactor(some_map(), i), x);
  EXPECT_NEAR(cost_of(MapFactor(some_map(), i).scaled(0.8), x),
              0.8 * cost_of(MapFactor(some_map(), i), x), 1e-10);
}

TEST_P(TwoNodes, PriorFactorHasItsGradientAndItsCovariance) {
  RandomStream random(7, "prior");
  Matrix18d A;
  for (int k = 0; k < 18 * 18; ++k) A(k) = random.normal();
  const Matrix18d covariance = A * A.transpose() + Matrix18d::Identity();
  const PriorFactor prior(i, covariance);
  NodeBlock block;
  double cost = 0;
  prior.add_to(i, block, cost);
  EXPECT_LT((block.H * covariance - Matrix18d::Identity()).norm(),
            tolerances::kRounding * covariance.norm() * block.H.norm());
  EXPECT_LT(block.g.norm() + cost, tolerances::kRounding * block.H.norm());
  NodeState x = i;
  x.add(testing::random_tangent(random, 0.2));
  expect_gradient_of_cost(prior, x);
}

INSTANTIATE_TEST_SUITE_P(IdentityNearItRandomAndNearPi, TwoNodes, testing::kRotations);

}  // namespace
}  // namespace holdfast::estimator
