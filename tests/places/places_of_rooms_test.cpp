#include <gtest/gtest.h>

#include <cmath>

#include "tests/places/placed_map.hpp"

/// Places of scenes whose answer is known.
namespace holdfast::places {
namespace {

using namespace testing;

constexpr double kFloorNoise = 0.03;  // m, of a plane fitted to points with 5 mm of noise, at most
constexpr float kSensorHeight = PlacesOptions{}.sensor_height_m;

/// Mean weight of points that are off by `sigmas` of what is expected of them:
/// E (c^2 / (c^2 + k^2))^2, k normal.
double mean_weight(double sigmas) {
  const double c_sq = std::pow(ViewOptions{}.robust_scale, 2);
  double sum = 0, mass = 0;
  for (double k = -6; k <= 6; k += 0.01) {
    const double density = std::exp(-0.5 * k * k);
    sum += density * std::pow(c_sq / (c_sq + sigmas * sigmas * k * k), 2);
    mass += density;
  }
  return sum / mass;
}

struct BoxRoom : ::testing::Test {
  Vector3d low{2, 3, 0}, high{14, 11, 3};
  Places places = PlacedMap(room(low, high)).open();
};

TEST_F(BoxRoom, HasPlacesInsideAboveItsFloor) {
  // 11 x 7 m are 0.5 m from the walls; discs of 3 m about places cover them, of 1.5 m are apart.
  const double free_m2 = 11 * 7;
  EXPECT_GE(places.all().size(), free_m2 / (M_PI * 9));
  EXPECT_LE(places.all().size(), 12 * 8 / (M_PI * 1.5 * 1.5));
  for (const Place& place : places.all()) {
    const Vector3d p = places.position(place);
    EXPECT_NEAR(p.z(), low.z() + kSensorHeight, kFloorNoise);
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_GT(p[axis], low[axis] + 0.3);
      EXPECT_LT(p[axis], high[axis] - 0.3);
    }
  }
}

TEST_F(BoxRoom, PlacesAreApart) {
  for (const Place& a : places.all()) {
    for (const Place& b : places.all()) {
      if (&a == &b) continue;
      EXPECT_GE((a.position - b.position).norm(), PlacesOptions{}.spacing_m);
    }
  }
}

TEST_F(BoxRoom, AllRaysEndAtItsSidesAndAgree) {
  ASSERT_FALSE(places.all().empty());
  for (const Place& place : places.all()) {
    EXPECT_GT(place.hit_share, 0.99F);
    // Points near the twelve edges belong to two planes and are left out: some per cent.
    EXPECT_GT(place.agreeing_share, 0.85 * mean_weight(1.0));
    // Only the noise of the range is left of what is allowed for: seen under the steepest beam,
    // 20 mm * sin(15 deg) of that and 5 mm of thickness and 4 mm of the plane.
    const double range = 0.02 * std::sin(15 * M_PI / 180);
    EXPECT_LT(place.agreeing_share, mean_weight(range / std::hypot(range, 0.005, 0.004)));
    EXPECT_LT(place.through_share, 0.01F);
    EXPECT_LT(place.in_front_share + place.unmapped_share, 0.01F);
  }
}

TEST_F(BoxRoom, AllDirectionsAreKnown) {
  for (const Place& place : places.all()) {
    EXPECT_GT(place.weakest_sigma_m, 0.02 / std::sqrt(5760.0)) << "better than all rays together";
    EXPECT_LT(place.weakest_sigma_m, 0.005F);
    EXPECT_NEAR(place.weakest.norm(), 1.0F, 1e-4F);
  }
}

TEST(LongTube, IsWeakAlongItself) {
  const Places places = PlacedMap(room({0, 0, 0}, {60, 3, 3}, false)).open();
  int inside = 0;
  for (const Place& place : places.all()) {
    if (place.position.x() < 10 || place.position.x() > 50) continue;
    ++inside;
    EXPECT_GT(place.weakest_sigma_m, kPoorSigmaM);
    EXPECT_GT(std::abs(place.weakest.x()), 0.99F);
  }
  EXPECT_GE(inside, 40 / 6);
}

TEST(Table, HasNoPlaceOnItOrInIt) {
  const Vector3d corner(4, 3, 0.75), size(2.4, 1.2, 0);
  RandomStream random(2, "table");
  io::PointCloud cloud = room({0, 0, 0}, {10, 8, 3});
  add_patch(corner, {size.x(), 0, 0}, {0, size.y(), 0}, random, cloud.points);
  const Places places = PlacedMap(std::move(cloud)).open();
  EXPECT_GT(places.all().size(), 4U);
  for (const Place& place : places.all()) {
    const Vector3d p = places.position(place);
    EXPECT_NEAR(p.z(), kSensorHeight, kFloorNoise);
    EXPECT_FALSE(p.x() > corner.x() && p.x() < corner.x() + size.x() && p.y() > corner.y() &&
                 p.y() < corner.y() + size.y())
        << p.transpose();
  }
}

TEST(TwoFloors, BothHavePlacesAndTheOwnFloorIsNearest) {
  constexpr double kUpper = 3.0;
  RandomStream random(3, "floors");
  io::PointCloud cloud;
  add_room({0, 0, 0}, {12, 8, 2.7}, true, random, cloud);
  add_room({0, 0, kUpper}, {12, 8, kUpper + 2.7}, true, random, cloud);
  const Places places = PlacedMap(std::move(cloud)).open();
  int above = 0, below = 0;
  for (const Place& place : places.all()) {
    const Vector3d p = places.position(place);
    (p.z() > kUpper ? above : below)++;
    EXPECT_NEAR(p.z(), kSensorHeight + (p.z() > kUpper ? kUpper : 0), kFloorNoise);
    for (const double height : {0.2, 0.6, 1.8}) {
      const Vector3d robot(p.x(), p.y(), (p.z() > kUpper ? kUpper : 0) + height);
      const Place* found = places.nearest(robot, 10.0);
      ASSERT_NE(found, nullptr);
      EXPECT_NEAR(found->position.z(), place.position.z(), kFloorNoise);
    }
  }
  EXPECT_GE(below, 4);
  EXPECT_GE(above, 4);
}

TEST(Island, ThatNothingLeadsToIsLeftOut) {
  io::PointCloud cloud = room({0, 0, 0}, {16, 12, 6});
  RandomStream random(4, "container");
  add_patch({6, 5, 2.5}, {2.4, 0, 0}, {0, 2.4, 0}, random, cloud.points);
  const Places places = PlacedMap(std::move(cloud)).open();
  for (const Place& place : places.all()) {
    EXPECT_NEAR(place.position.z(), kSensorHeight, kFloorNoise);
  }
}

TEST(OpenFloor, WithNothingAroundHasNoPlaces) {
  for (const double side : {2.0, 20.0}) {
    RandomStream random(5, "floor");
    io::PointCloud cloud;
    add_patch({0, 0, 0}, {side, 0, 0}, {0, side, 0}, random, cloud.points);
    const Places places = PlacedMap(std::move(cloud)).open();
    EXPECT_TRUE(places.all().empty());
    EXPECT_EQ(places.nearest({1, 1, 1}, 1e9), nullptr);
  }
}

TEST(FarFromTheOrigin, PlacesAreWhereTheMapIs) {
  io::PointCloud cloud = room({0, 0, 0}, {10, 8, 3});
  cloud.origin = {450'000, 5'400'000, 300};
  const Places places = PlacedMap(std::move(cloud)).open();
  ASSERT_FALSE(places.all().empty());
  for (const Place& place : places.all()) {
    const Vector3d p = places.position(place) - Vector3d(450'000, 5'400'000, 300);
    EXPECT_NEAR(p.z(), kSensorHeight, kFloorNoise);
    EXPECT_TRUE(p.x() > 0 && p.x() < 10 && p.y() > 0 && p.y() < 8) << p.transpose();
    EXPECT_EQ(places.nearest(places.position(place), 0.1), &place);
  }
}

}  // namespace
}  // namespace holdfast::places
