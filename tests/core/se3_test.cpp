#include "holdfast/core/se3.hpp"

#include <gtest/gtest.h>

#include "tests/core/rotations.hpp"
#include "tests/tolerances.hpp"

namespace holdfast::testing {
namespace {

using Eigen::Vector3d;
using tolerances::kRounding;

SE3 random_pose(RandomStream& random) {
  return {so3::exp(random.uniform(0, 3.0) * random_direction(random)),
          random.uniform(0, 1.0) * random_direction(random)};
}

Eigen::Matrix4d matrix(const SE3& T) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = T.rotation.toRotationMatrix();
  m.topRightCorner<3, 1>() = T.translation;
  return m;
}

TEST(Se3, ComposesLikeHomogeneousMatrices) {
  RandomStream random(3, "poses");
  for (int i = 0; i < 100; ++i) {
    const SE3 T_a_b = random_pose(random);
    const SE3 T_b_c = random_pose(random);
    EXPECT_LE((matrix(T_a_b * T_b_c) - matrix(T_a_b) * matrix(T_b_c)).cwiseAbs().maxCoeff(),
              kRounding);
  }
}

TEST(Se3, MapsPointsOfBIntoA) {
  const SE3 T_a_b{so3::exp({0, 0, std::numbers::pi / 2}), {10, 0, 0}};
  EXPECT_LE((T_a_b * Vector3d(1, 0, 2) - Vector3d(10, 1, 2)).norm(), 10 * kRounding);
}

TEST(Se3, TheInverseUndoesIt) {
  RandomStream random(4, "poses");
  for (int i = 0; i < 100; ++i) {
    const SE3 T = random_pose(random);
    const SE3 identity = T.inverse() * T;
    EXPECT_LE(identity.translation.norm(), kRounding);
    EXPECT_LE(so3::log(identity.rotation).norm(), kRounding);
  }
}

TEST(Se3, AMillionProductsKeepAUnitQuaternion) {
  const SE3 step{so3::exp({0.01, -0.02, 0.03}), {0.1, 0, 0}};
  SE3 T;
  for (int i = 0; i < 1'000'000; ++i) T = T * step;
  EXPECT_NEAR(T.rotation.norm(), 1.0, kRounding);
}

TEST(Se3Interpolate, MeetsItsEndsAndMovesAtAConstantRate) {
  RandomStream random(5, "poses");
  for (int i = 0; i < 100; ++i) {
    const SE3 a = random_pose(random);
    const Vector3d phi = random.uniform(0.01, 2.5) * random_direction(random);
    const SE3 b{a.rotation * so3::exp(phi), a.translation + Vector3d(1, -1, 0.5)};
    EXPECT_LE(so3::angle_between(interpolate(a, b, 0).rotation, a.rotation), kRounding);
    EXPECT_LE(so3::angle_between(interpolate(a, b, 1).rotation, b.rotation), kRounding);
    for (const double u : {0.25, 0.5, 0.9}) {
      const SE3 middle = interpolate(a, b, u);
      // slerp divides by the sine of the angle: the roundings of its weights grow by that.
      EXPECT_LE((so3::log(a.rotation.conjugate() * middle.rotation) - u * phi).norm(),
                kRounding / std::sin(phi.norm() / 2));
      EXPECT_LE((middle.translation - a.translation - u * Vector3d(1, -1, 0.5)).norm(), kRounding);
    }
  }
}

}  // namespace
}  // namespace holdfast::testing
