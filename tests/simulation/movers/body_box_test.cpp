#include "simulation/movers/body_box.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerances.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

const BodyBox kBox{{1, 2, 3}, {2, 4, 6}, materials::kPaintedMetal};

TEST(BodyBox, IsMetOnTheSideThatFacesTheRay) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const Vector3d outwards = sign * Vector3d::Unit(axis);
      BoxHit hit;
      ASSERT_TRUE(intersect(kBox, kBox.center + 10 * outwards, -outwards, 0, 100, hit));
      EXPECT_DOUBLE_EQ(hit.range, 10 - 0.5 * kBox.size[axis]);
      EXPECT_EQ(hit.normal, outwards);
    }
  }
}

TEST(BodyBox, IsMetWhereASlantingRayEntersIt) {
  const Vector3d entry(0, 1, 4);  // on the side towards -x
  const Vector3d direction = Vector3d(2, 1, -0.5).normalized();
  BoxHit hit;
  ASSERT_TRUE(intersect(kBox, entry - 7 * direction, direction, 0, 100, hit));
  EXPECT_NEAR(hit.range, 7, 7 * tolerances::kRounding);
  EXPECT_EQ(hit.normal, -Vector3d::UnitX());
}

TEST(BodyBox, IsNotMetBesideBehindBeyondOrFromWithin) {
  BoxHit hit;
  EXPECT_FALSE(intersect(kBox, {-10, 4.1, 3}, Vector3d::UnitX(), 0, 100, hit)) << "beside";
  EXPECT_FALSE(intersect(kBox, {10, 2, 3}, Vector3d::UnitX(), 0, 100, hit)) << "behind";
  EXPECT_FALSE(intersect(kBox, {-10, 2, 3}, Vector3d::UnitX(), 0, 9.9, hit)) << "beyond";
  EXPECT_FALSE(intersect(kBox, {-10, 2, 3}, Vector3d::UnitX(), 10.1, 100, hit)) << "too near";
  EXPECT_FALSE(intersect(kBox, kBox.center, Vector3d::UnitX(), 0, 100, hit)) << "from within";
}

}  // namespace
}  // namespace holdfast::simulation
