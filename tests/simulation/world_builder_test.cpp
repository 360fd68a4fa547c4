#include "simulation/world/world_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulation/world/ray_caster.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kFloat = 1e-5;  // vertices are floats of at most 10: 6e-7 each, summed over a few

struct Totals {
  double area = 0;
  double volume = 0;  ///< enclosed when all fronts look outwards (Gauss)
};

Totals totals(const World& world) {
  Totals out;
  for (const auto& t : world.triangles) {
    const Vector3d a = world.vertices[t[0]].cast<double>();
    const Vector3d b = world.vertices[t[1]].cast<double>();
    const Vector3d c = world.vertices[t[2]].cast<double>();
    out.area += 0.5 * (b - a).cross(c - a).norm();
    out.volume += a.dot(b.cross(c)) / 6;
  }
  return out;
}

TEST(WorldBuilder, BoxHasItsAreaAndFrontsOutside) {
  WorldBuilder build;
  build.box({{3, 2, 1}, {1, 2, 3}, 0.7}, materials::kIdeal);
  const Totals t = totals(build.build());
  EXPECT_NEAR(t.area, 2 * (2 + 3 + 6), kFloat);
  EXPECT_NEAR(t.volume, 6, kFloat);
}

TEST(WorldBuilder, CylinderIsTheFacetedSolidOfItsRadius) {
  WorldBuilder build;
  constexpr int kSegments = 24;
  build.cylinder({1, 1, 0}, 0.5, 2, materials::kIdeal, kSegments);
  const double base = 0.5 * kSegments * 0.25 * std::sin(2 * std::numbers::pi / kSegments);
  const Totals t = totals(build.build());
  EXPECT_NEAR(t.volume, 2 * base, kFloat);
  const double side = 2 * 0.5 * std::sin(std::numbers::pi / kSegments);
  EXPECT_NEAR(t.area, 2 * base + kSegments * side * 2, kFloat);
}

TEST(WorldBuilder, ConeAndEllipsoidLookOutwards) {
  WorldBuilder cone;
  cone.cone({0, 0, 0}, 1, 0, 3, materials::kIdeal, 64);
  const double base = 0.5 * 64 * std::sin(2 * std::numbers::pi / 64);
  EXPECT_NEAR(totals(cone.build()).volume, base, kFloat);
  WorldBuilder ellipsoid;
  ellipsoid.ellipsoid({4, 0, 2}, {1, 2, 3}, materials::kIdeal, 64);
  const double smooth = 4.0 / 3.0 * std::numbers::pi * 6;
  const double faceted = totals(ellipsoid.build()).volume;
  EXPECT_LT(faceted, smooth);
  EXPECT_GT(faceted, smooth * (1 - 2 * std::pow(2 * std::numbers::pi / 64, 2)));
}

// A floor and a ceiling look at each other, walls with their left side into the room: with every
// front inside, Gauss gives minus the volume; a recess adds what it is deep.
TEST(WorldBuilder, WallsLookLeftAndRecessesAreClosed) {
  WorldBuilder build;
  build.floor({0, 0}, {4, 3}, 0, materials::kIdeal);
  build.ceiling({0, 0}, {4, 3}, 2, materials::kIdeal);
  const WallOpening door{2.5, 1, 0, 1.5, 0.2};
  const WallOpening niche{0.5, 0.5, 0.4, 1.0, 0.3};
  build.wall({{0, 0}, {4, 0}, 0, 2, materials::kIdeal, {door, niche}});
  build.wall({{4, 0}, {4, 3}, 0, 2, materials::kIdeal, {}});
  build.wall({{4, 3}, {0, 3}, 0, 2, materials::kIdeal, {}});
  build.wall({{0, 3}, {0, 0}, 0, 2, materials::kIdeal, {}});
  // The door has no sill of its own (the floor passes under it): one quad of height 0 is missing.
  const double expected = 4 * 3 * 2 + 1 * 1.5 * 0.2 + 0.5 * 0.6 * 0.3;
  EXPECT_NEAR(totals(build.build()).volume, -expected, kFloat);
}

TEST(WorldBuilder, PassageLetsRaysThrough) {
  WorldBuilder build;
  build.wall({{0, 0}, {4, 0}, 0, 2, materials::kIdeal, {{1, 1, 0, 1.5, 0.2, true}}});
  const RayCaster caster(build.build());
  EXPECT_TRUE(caster.is_visible({1.5F, 1, 1}, {1.5F, -1, 1}));
  EXPECT_FALSE(caster.is_visible({1.5F, 1, 1.8F}, {1.5F, -1, 1.8F}));
  EXPECT_FALSE(caster.is_visible({0.5F, 1, 1}, {0.5F, -1, 1}));
}

TEST(WorldBuilder, OneMaterialIsKeptOnce) {
  WorldBuilder build;
  build.box({{0, 0, 0}, {1, 1, 1}}, materials::kWood);
  build.box({{3, 0, 0}, {1, 1, 1}}, materials::kGlass);
  build.box({{6, 0, 0}, {1, 1, 1}}, materials::kWood);
  const World world = build.build();
  EXPECT_EQ(world.materials.size(), 2U);
  EXPECT_EQ(world.material_of.size(), world.triangles.size());
  EXPECT_EQ(world.material_of.front(), world.material_of.back());
}

TEST(Material, ReturnsFadeWhenGrazingAndShineWhenSquare) {
  const Material floor{"floor", 0.5, 0.8, 0.1};
  EXPECT_DOUBLE_EQ(floor.return_probability(1), 0.8);
  EXPECT_DOUBLE_EQ(floor.return_probability(0.1), 0.8);
  EXPECT_DOUBLE_EQ(floor.return_probability(0.05), 0.4);
  const Material mirror{"mirror", 0.5, 0.1, 0, 0.6, 0.2};
  EXPECT_DOUBLE_EQ(mirror.return_probability(1), 0.7);
  EXPECT_NEAR(mirror.return_probability(std::cos(0.2)), 0.1 + 0.6 * std::exp(-1), 1e-3);
  EXPECT_NEAR(mirror.return_probability(std::cos(1.0)), 0.1, 1e-9);
  const Material bright{"bright", 0.5, 0.9, 0, 0.6, 0.2};
  EXPECT_DOUBLE_EQ(bright.return_probability(1), 1);
}

}  // namespace
}  // namespace holdfast::simulation
