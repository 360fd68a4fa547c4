#include "holdfast/pipeline/graph/placement.hpp"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <numbers>

namespace holdfast::pipeline {
namespace {

using estimator::Matrix18d;
using estimator::NodeState;

/// A robot that drives along x of its odometry, whose map is turned by 90 degrees against it.
struct Turned {
  filter::FilterState odometry;
  Placement found;
  Eigen::Vector3d gravity = Eigen::Vector3d(0, 0, -9.81);

  Turned() {
    odometry.t = 5 * kSecond;
    odometry.T_map_body = {so3::exp(Eigen::Vector3d(0, 0, 0.3)), {7, 0, 0}};
    odometry.v_map = {1.2, 0, 0};
    odometry.accel_bias = {0.01, 0.02, 0.03};
    odometry.gyro_bias = {0.001, 0.002, 0.003};
    odometry.P = 1e-4 * filter::Matrix15d::Identity();
    const Eigen::Quaterniond quarter = so3::exp(Eigen::Vector3d(0, 0, std::numbers::pi / 2));
    found.T_map_body = {quarter * odometry.T_map_body.rotation, {20, 30, 1}};
    found.covariance = 0.01 * estimator::Matrix6d::Identity();
  }

  PlacedNode node() const { return place_node(found, odometry, gravity, 0.05); }
};

TEST(PlaceNode, KeepsBiasesAndTurnsTheVelocityIntoTheMap) {
  const Turned turned;
  const NodeState x = turned.node().x;
  EXPECT_EQ(x.t, turned.odometry.t);
  EXPECT_EQ(x.T_map_body.translation, turned.found.T_map_body.translation);
  EXPECT_LT((x.v_map - Eigen::Vector3d(0, 1.2, 0)).norm(), 1e-12);
  EXPECT_EQ(x.accel_bias, turned.odometry.accel_bias);
  EXPECT_EQ(x.gyro_bias, turned.odometry.gyro_bias);
  EXPECT_EQ(x.gravity_map, turned.gravity);
}

TEST(PlaceNode, TheCovarianceIsOneAndWiderThanWhatWasKnown) {
  const Turned turned;
  const Matrix18d P = turned.node().P;
  EXPECT_LT((P - P.transpose()).norm(), 1e-15);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix18d>(P).eigenvalues().minCoeff(), 0.0);
  for (int i = 0; i < 15; ++i) {
    EXPECT_GT(P(i, i), turned.odometry.P(i, i)) << "of the odometry, " << i;
    if (i < 6) {
      EXPECT_GT(P(i, i), turned.found.covariance(i, i)) << "of the search, " << i;
    }
  }
}

TEST(PlaceNode, AVelocityIsAsUncertainAsTheHeadingThatItGoesAlong) {
  Turned turned;
  const double before = turned.node().P(NodeState::kV, NodeState::kV);
  turned.odometry.v_map *= 10;
  EXPECT_GT(turned.node().P(NodeState::kV, NodeState::kV), 10 * before);
}

/// The accelerometer feels bias and gravity as one: of their sum no more is known than before.
TEST(PlaceNode, GravityAndTheBiasOfTheAccelerometerAreKnownTogether) {
  const Turned turned;
  const Matrix18d P = turned.node().P;
  const Eigen::Matrix3d R = turned.found.T_map_body.rotation.toRotationMatrix();
  Eigen::Matrix<double, 3, 18> felt = Eigen::Matrix<double, 3, 18>::Zero();
  felt.middleCols<3>(NodeState::kBa).setIdentity();
  felt.middleCols<3>(NodeState::kG) = -R.transpose();
  const Eigen::Matrix3d of_sum = felt * P * felt.transpose();
  EXPECT_LT((of_sum - 4e-4 * Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

}  // namespace
}  // namespace holdfast::pipeline
