#include "holdfast/registration/levenberg_marquardt.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <vector>

#include "holdfast/core/random.hpp"
#include "tests/tolerances.hpp"

namespace holdfast::registration {
namespace {

using Eigen::Vector3d;

/// A body point and the plane n . x = offset that it lies on.
struct Pair {
  Vector3d q, n;
  double offset;
};

double residual(const Pair& pair, const SE3& T) { return pair.n.dot(T * pair.q) - pair.offset; }

Vector6d jacobian(const Pair& pair, const SE3& T) {
  Vector6d J;
  J << pair.n, pair.q.cross(T.rotation.conjugate() * pair.n);
  return J;
}

/// Points anywhere on the sides of a room of 8 x 6 x 3 m, seen from `truth`.
std::vector<Pair> room_pairs(const SE3& truth, const std::string& axes = "xyz") {
  RandomStream random(1, "room");
  const Vector3d half(4, 3, 1.5);
  std::vector<Pair> pairs;
  for (const char name : axes) {
    const int axis = name - 'x';
    for (int i = 0; i < 200; ++i) {
      Vector3d p;
      for (int k = 0; k < 3; ++k) p[k] = random.uniform(-half[k], half[k]);
      p[axis] = i % 2 == 0 ? half[axis] : -half[axis];
      pairs.push_back({truth.inverse() * p, Vector3d::Unit(axis), p[axis]});
    }
  }
  return pairs;
}

PoseModel model_of(const std::vector<Pair>& pairs, const SE3& T) {
  PoseModel model;
  for (const Pair& pair : pairs) model.add(residual(pair, T), jacobian(pair, T), 1.0);
  return model;
}

LevenbergMarquardtResult solve(const std::vector<Pair>& pairs, const SE3& start) {
  return minimise_by_levenberg_marquardt(start, [&](const SE3& T) { return model_of(pairs, T); });
}

double position_error(const SE3& a, const SE3& b) { return (a.translation - b.translation).norm(); }

const SE3 kTruth{so3::exp({0.1, -0.2, 1.1}), {0.7, -0.4, 0.2}};

TEST(PoseModel, GradientAndJacobianAreThoseOfFiniteDifferences) {
  for (const Vector3d& turn : {Vector3d(0, 0, 0), Vector3d(1e-8, 0, 0), Vector3d(0.3, -1, 0.5),
                               Vector3d(0, 0, std::numbers::pi - 1e-6)}) {
    const SE3 T{so3::exp(turn), {0.3, 0.2, -0.1}};
    const std::vector<Pair> pairs = room_pairs(kTruth);
    const PoseModel model = model_of(pairs, T);
    for (int axis = 0; axis < 6; ++axis) {
      const double h = tolerances::kDifferenceStep;
      const Vector6d step = h * Vector6d::Unit(axis);
      double cost_slope = 0;
      for (const Pair& pair : pairs) {
        const double numeric =
            (residual(pair, moved(T, step)) - residual(pair, moved(T, -step))) / (2 * h);
        // Residuals and their third derivatives are bounded by the room's reach of 6 m.
        EXPECT_NEAR(jacobian(pair, T)[axis], numeric,
                    tolerances::difference_error(6, 6 * tolerances::kRounding));
        cost_slope += 2 * residual(pair, T) * numeric;
      }
      EXPECT_NEAR(2 * model.g[axis], cost_slope, 1e-6 * std::abs(cost_slope) + 1e-5);
    }
  }
}

/// With known correspondences the cost is all but quadratic: any start below a right angle leads
/// to the truth.
TEST(LevenbergMarquardt, FindsARoomFromAMetreAndSixtyDegreesAway) {
  const std::vector<Pair> pairs = room_pairs(kTruth);
  RandomStream random(2, "starts");
  for (int k = 0; k < 100; ++k) {
    Vector6d off;
    for (int i = 0; i < 3; ++i) off[i] = random.uniform(-1, 1);
    Vector3d axis(random.normal(), random.normal(), random.normal());
    off.tail<3>() = axis.normalized() * random.uniform(0, std::numbers::pi / 3);
    const auto found = solve(pairs, moved(kTruth, off));
    EXPECT_TRUE(found.converged);
    EXPECT_LT(position_error(found.pose, kTruth), 1e-6);
    EXPECT_LT(so3::angle_between(found.pose.rotation, kTruth.rotation), 1e-6);
    EXPECT_LT(found.cost, 1e-9);
  }
}

TEST(LevenbergMarquardt, NeverEndsHigherThanItStarted) {
  const std::vector<Pair> pairs = room_pairs(kTruth);
  for (int k = 1; k <= 12; ++k) {
    LevenbergMarquardtOptions options;
    options.max_iterations = k;
    const SE3 start = moved(kTruth, (Vector6d() << 3, -2, 1, 1, 2, -1).finished());
    const auto found = minimise_by_levenberg_marquardt(
        start, [&](const SE3& T) { return model_of(pairs, T); }, options);
    EXPECT_LE(found.cost, model_of(pairs, start).cost);
    EXPECT_LE(found.iterations, k);
    EXPECT_EQ(found.cost, model_of(pairs, found.pose).cost);
  }
}

TEST(LevenbergMarquardt, DoesNotMoveAlongWhatNothingDetermines) {
  const std::vector<Pair> corridor = room_pairs(SE3{}, "yz");
  const SE3 start{so3::exp({0.02, 0.01, -0.03}), {0.5, 0.2, -0.1}};
  const auto found = solve(corridor, start);
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.pose.translation.x(), 0.5, 0.01);
  EXPECT_NEAR(found.pose.translation.y(), 0, 1e-6);
  EXPECT_NEAR(found.pose.translation.z(), 0, 1e-6);
}

TEST(LevenbergMarquardt, WithoutResidualsStaysWhereItIs) {
  const auto found = solve({}, kTruth);
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.pose.translation, kTruth.translation);
  EXPECT_EQ(found.cost, 0);
}

}  // namespace
}  // namespace holdfast::registration
