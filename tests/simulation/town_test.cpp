#include "simulation/scenarios/town.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace holdfast::simulation {
namespace {

using Corners = std::array<float, 9>;

Corners corners_of(const World& world, std::size_t triangle) {
  Corners out;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& p = world.vertices[world.triangles[triangle][k]];
    for (int axis = 0; axis < 3; ++axis) out[3 * k + static_cast<std::size_t>(axis)] = p[axis];
  }
  return out;
}

TEST(Town, ThatIsLargerContainsTheSmallerOne) {
  const World small = make_town(0.03).world;
  const World large = make_town(0.15).world;
  std::set<Corners> all;
  for (std::size_t i = 0; i < large.triangles.size(); ++i) all.insert(corners_of(large, i));
  for (std::size_t i = 0; i < small.triangles.size(); ++i) {
    ASSERT_TRUE(all.contains(corners_of(small, i))) << "triangle " << i;
  }
  EXPECT_GT(large.triangles.size(), 3 * small.triangles.size());
}

TEST(Town, HasTheSizeThatIsAskedFor) {
  for (const double km2 : {0.1, 0.3, 1.0}) {
    const World world = make_town(km2).world;
    Eigen::Vector2f high(0, 0);
    for (const auto& p : world.vertices) high = high.cwiseMax(p.head<2>());
    EXPECT_NEAR(high.prod() * 1e-6, km2, 0.2 * km2) << "whole meshes of 75 x 70 m";
  }
}

/// Of a triangle that lies flat, in square metres.
double flat_area(const Corners& c) {
  if (c[2] != c[5] || c[5] != c[8]) return 0;
  return 0.5 * std::abs((c[3] - c[0]) * (c[7] - c[1]) - (c[6] - c[0]) * (c[4] - c[1]));
}

/// Houses are compared by the heights of their roofs, which are larger than any sill.
TEST(Town, HasNoTwoHousesThatAreAlike) {
  const World world = make_town(0.3).world;
  std::set<int> heights;
  std::size_t roofs = 0;
  for (std::size_t i = 0; i < world.triangles.size(); ++i) {
    const Corners c = corners_of(world, i);
    if (c[2] < 5 || flat_area(c) < 25) continue;
    ++roofs;
    heights.insert(static_cast<int>(std::lround(c[2] * 1e5)));
  }
  // Two triangles a roof, each of a height of its own.
  EXPECT_GT(heights.size(), roofs / 2 * 9 / 10);
}

TEST(Town, IsNamedWithItsSize) {
  const auto town = make_scenario("town:0.05km2");
  ASSERT_TRUE(town) << town.error().message;
  EXPECT_EQ(town->world.triangles.size(), make_town(0.05).world.triangles.size());
  EXPECT_FALSE(town->vehicles.empty());
  for (const char* name :
       {"town:", "town:2", "town:km2", "town:0.01km2", "town:11km2", "town:1km2x", "town:nankm2"}) {
    const auto wrong = make_scenario(name);
    ASSERT_FALSE(wrong) << name;
    EXPECT_THAT(wrong.error().message, ::testing::HasSubstr("town:SIZEkm2")) << name;
    EXPECT_THAT(wrong.error().message, ::testing::HasSubstr("0.03 to 10")) << name;
  }
}

}  // namespace
}  // namespace holdfast::simulation
