#include "simulation/clouds/cloud_discs.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "holdfast/core/random.hpp"
#include "simulation/world/ray_caster.hpp"
#include "simulation/world/world_builder.hpp"
#include "tests/simulation/tolerances.hpp"
#include "tests/simulation/world_files.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using testing::cast_one;

constexpr double kSpacing = 0.2;
constexpr double kThin = 0.01;  // of the thinning: less than any two points are apart

/// Points over a rectangle from `corner` along `u` and `v`, one near the middle of each square.
void add_face(std::vector<Vector3f>& points, const Vector3d& corner, const Vector3d& u,
              const Vector3d& v, RandomStream& random, double sigma = 0) {
  const Vector3d normal = u.cross(v).normalized();
  for (double a = 0.5 * kSpacing; a < u.norm(); a += kSpacing) {
    for (double b = 0.5 * kSpacing; b < v.norm(); b += kSpacing) {
      const double x = a + kSpacing * random.uniform(-0.3, 0.3);
      const double y = b + kSpacing * random.uniform(-0.3, 0.3);
      const Vector3d p = corner + x * u.normalized() + y * v.normalized();
      points.push_back((p + sigma * random.normal() * normal).cast<float>());
    }
  }
}

CloudDiscs discs(const std::vector<Vector3f>& points, int threads = 1) {
  WorkerPool pool(threads);
  return discs_of(points, kThin, pool);
}

World world_of(const CloudDiscs& discs) {
  WorldBuilder build;
  for (const Disc& disc : discs.surfaces) build.disc(disc, materials::kConcrete);
  for (const Disc& disc : discs.scattered) build.disc(disc, materials::kFoliage);
  return build.build();
}

/// A floor of 10 x 10 m, noise-free.
std::vector<Vector3f> floor_points(double sigma = 0) {
  std::vector<Vector3f> points;
  RandomStream random(3, "floor");
  add_face(points, {0, 0, 0}, {10, 0, 0}, {0, 10, 0}, random, sigma);
  return points;
}

TEST(CloudDiscs, CloseASurfaceAndLieOnIt) {
  const World world = world_of(discs(floor_points()));
  const RayCaster caster(world);
  RandomStream random(4, "rays");
  int holes = 0;
  for (int i = 0; i < 10000; ++i) {
    const Vector3d to(random.uniform(0.4, 9.6), random.uniform(0.4, 9.6), 0);
    const Vector3d from = to + Vector3d(random.uniform(-3, 3), random.uniform(-3, 3), 5);
    const HitPacket hits = cast_one(caster, from, to - from);
    if (std::isinf(hits.range[0])) {
      ++holes;
      continue;
    }
    const double cosine = 5 / (to - from).norm();
    ASSERT_NEAR(hits.range[0], (to - from).norm(), tolerances::kRayInRoom / cosine);
    ASSERT_NEAR(hits.cos_incidence[0], cosine, 1e-4);
    ASSERT_STREQ(world.materials[hits.material[0]].name, "concrete");
  }
  EXPECT_LE(holes, 10);  // one in a thousand
}

// The outermost points lie 0.3 spacings within the rim at most 0.8; discs of a rim reach 0.4 of a
// spacing's diagonal on.
TEST(CloudDiscs, DoNotGrowOverTheRim) {
  const RayCaster caster(world_of(discs(floor_points())));
  RandomStream random(5, "rays");
  int beyond = 0;
  for (int i = 0; i < 10000; ++i) {
    const Vector3d from(random.uniform(-1, 11), -0.5 * kSpacing * random.uniform(1, 5), 5);
    beyond += std::isfinite(testing::casts_down(caster, from)) ? 1 : 0;
  }
  EXPECT_EQ(beyond, 0);
}

TEST(CloudDiscs, KeepTheCornerOfThreeWallsSharp) {
  std::vector<Vector3f> points;
  RandomStream random(6, "corner");
  const Vector3d x(6, 0, 0), y(0, 6, 0), z(0, 0, 6);
  add_face(points, Vector3d::Zero(), x, y, random);
  add_face(points, Vector3d::Zero(), x, z, random);
  add_face(points, Vector3d::Zero(), y, z, random);
  const CloudDiscs corner = discs(points);
  std::size_t skew = 0;
  for (const Disc& disc : corner.surfaces) {
    skew += disc.normal.cwiseAbs().maxCoeff() < std::cos(3 * M_PI / 180) ? 1U : 0U;
  }
  const double all = static_cast<double>(points.size());
  EXPECT_LT(static_cast<double>(skew), 0.002 * all);
  EXPECT_LT(static_cast<double>(corner.scattered.size()), 0.01 * all);
}

// A plane through 16 points of deviation sigma, seen at one of them, errs by sigma sqrt(3 / 16) and
// by somewhat more off their middle; the nearer of overlapping discs is met. Half of sigma is left
// at most, and the bias towards the viewer is less than that.
TEST(CloudDiscs, TakeMostOfTheNoiseAway) {
  constexpr double kSigma = 0.03;
  const RayCaster caster(world_of(discs(floor_points(kSigma))));
  RandomStream random(8, "rays");
  double sum = 0, squares = 0;
  int n = 0;
  for (int i = 0; i < 10000; ++i) {
    const Vector3d from(random.uniform(1, 9), random.uniform(1, 9), 5);
    const double range = testing::casts_down(caster, from);
    if (!std::isfinite(range)) continue;
    sum += 5 - range;
    squares += (5 - range) * (5 - range);
    ++n;
  }
  const double mean = sum / n;
  EXPECT_LT(std::sqrt(squares / n - mean * mean), 0.5 * kSigma);
  EXPECT_GT(mean, 0);
  EXPECT_LT(mean, 0.5 * kSigma);
}

/// Share of rays that pass a cube of 4 m full of points, along an axis.
double passing(const RayCaster& caster, int axis) {
  RandomStream random(9, "rays");
  int passed = 0;
  constexpr int kRays = 20000;
  for (int i = 0; i < kRays; ++i) {
    Vector3d from(random.uniform(0.5, 3.5), random.uniform(0.5, 3.5), random.uniform(0.5, 3.5));
    from[axis] = -1;
    passed += std::isinf(cast_one(caster, from, Vector3d::Unit(axis)).range[0]) ? 1 : 0;
  }
  return static_cast<double>(passed) / kRays;
}

TEST(CloudDiscs, ACrownLetsTheSameShareOfRaysPassFromAllSides) {
  std::vector<Vector3f> points;
  RandomStream random(10, "crown");
  for (int i = 0; i < 2000; ++i) {
    points.emplace_back(static_cast<float>(random.uniform(0, 4)),
                        static_cast<float>(random.uniform(0, 4)),
                        static_cast<float>(random.uniform(0, 4)));
  }
  const CloudDiscs crown = discs(points);
  EXPECT_GT(crown.scattered.size(), 0.9 * 2000);
  double area = 0;
  for (const Disc& leaf : crown.scattered) area += M_PI * leaf.radius * leaf.radius;
  CloudDiscs leaves;
  leaves.scattered = crown.scattered;
  const RayCaster caster(world_of(leaves));
  // Beer's law: half of the leaves' area over the cross section of 16 m^2 is the optical depth. The
  // finite number of leaves makes the share vary by the square root of 2000 leaves' shadows.
  const double expected = std::exp(-0.5 * area / 16);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(passing(caster, axis), expected, 0.05);
}

TEST(CloudDiscs, AreTheSameForAnyNumberOfThreads) {
  const auto points = floor_points(0.03);
  const CloudDiscs one = discs(points, 1);
  const CloudDiscs two = discs(points, 2);
  ASSERT_EQ(one.surfaces.size(), two.surfaces.size());
  for (std::size_t i = 0; i < one.surfaces.size(); ++i) {
    EXPECT_EQ(one.surfaces[i].center, two.surfaces[i].center);
    EXPECT_EQ(one.surfaces[i].normal, two.surfaces[i].normal);
    EXPECT_EQ(one.surfaces[i].radius, two.surfaces[i].radius);
  }
}

TEST(CloudDiscs, OfFewPointsAreSmall) {
  EXPECT_TRUE(discs({}).surfaces.empty());
  const CloudDiscs three = discs({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_TRUE(three.surfaces.empty());
  ASSERT_EQ(three.scattered.size(), 3U);
  for (const Disc& disc : three.scattered) EXPECT_LE(disc.radius, 0.1F);
}

TEST(CloudDiscs, AreThinnedToOnePointACube) {
  std::vector<Vector3f> points = floor_points();
  const std::size_t once = points.size();
  points.insert(points.end(), points.begin(), points.begin() + 500);
  EXPECT_EQ(discs(points).surfaces.size() + discs(points).scattered.size(), once);
}

}  // namespace
}  // namespace holdfast::simulation
