#include "simulation/world/ray_caster.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "holdfast/core/random.hpp"
#include "simulation/scenario.hpp"
#include "simulation/world/capsule.hpp"
#include "simulation/world/world_builder.hpp"
#include "tests/simulation/tolerances.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

/// Distance from `origin` inside the box world (12 x 8 x 4 m) to its surface along `direction`, and
/// the cosine of incidence there.
std::pair<double, double> box_range(const Vector3d& origin, const Vector3d& direction) {
  const Vector3d size(12, 8, 4);
  double range = 1e9;
  double cosine = 0;
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0) continue;
    const double wall = direction[k] > 0 ? size[k] : 0;
    const double r = (wall - origin[k]) / direction[k];
    if (r < range) cosine = std::abs(direction[k]);
    range = std::min(range, r);
  }
  return {range, cosine};
}

TEST(RayCaster, GivesTheRangesOfARoomInClosedForm) {
  const Scenario box = *make_scenario("box");
  const RayCaster caster(box.world);
  RandomStream random(7, "rays");
  RayPacket rays;
  HitPacket hits;
  for (int packet = 0; packet < 2000; ++packet) {
    std::array<Vector3d, RayPacket::kSize> origins;
    std::array<Vector3d, RayPacket::kSize> directions;
    for (int i = 0; i < RayPacket::kSize; ++i) {
      origins[i] = {random.uniform(1, 11), random.uniform(1, 7), random.uniform(0.5, 3.5)};
      directions[i] = Vector3d(random.normal(), random.normal(), random.normal()).normalized();
      rays.x[i] = static_cast<float>(origins[i].x());
      rays.y[i] = static_cast<float>(origins[i].y());
      rays.z[i] = static_cast<float>(origins[i].z());
      rays.dx[i] = static_cast<float>(directions[i].x());
      rays.dy[i] = static_cast<float>(directions[i].y());
      rays.dz[i] = static_cast<float>(directions[i].z());
    }
    caster.cast(rays, 0, 100, hits);
    for (int i = 0; i < RayPacket::kSize; ++i) {
      const auto [range, cosine] = box_range(origins[i], directions[i]);
      ASSERT_NEAR(hits.range[i], range, tolerances::kRayInRoom / cosine);
      ASSERT_NEAR(hits.cos_incidence[i], cosine, 1e-6);
    }
  }
}

TEST(RayCaster, KeepsWithinItsRange) {
  const Scenario box = *make_scenario("box");
  const RayCaster caster(box.world);
  RayPacket rays{};
  rays.x.fill(6);
  rays.y.fill(4);
  rays.z.fill(1);
  rays.dx.fill(1);
  HitPacket hits;
  caster.cast(rays, 0.4F, 5.9F, hits);
  EXPECT_TRUE(std::isinf(hits.range[0]));
  caster.cast(rays, 6.1F, 100, hits);
  EXPECT_TRUE(std::isinf(hits.range[3]));
  caster.cast(rays, 0.4F, 100, hits);
  EXPECT_NEAR(hits.range[7], 6, tolerances::kRayInRoom);
}

TEST(RayCaster, SeesWhatIsNotHidden) {
  WorldBuilder build;
  build.box({{0, 0, 1}, {1, 1, 2}}, materials::kIdeal);
  const RayCaster caster(build.build());
  EXPECT_TRUE(caster.is_visible({2, 0, 1}, {0.5F, 0, 1}));    // the face before it
  EXPECT_FALSE(caster.is_visible({2, 0, 1}, {-0.5F, 0, 1}));  // the face behind
  EXPECT_TRUE(caster.is_visible({2, 0, 1}, {2, 5, 1}));
}

struct Shot {
  Vector3d origin;
  Vector3d direction;
  double range;  ///< negative: no hit
  double cosine;
};

TEST(Capsule, MeetsRaysInClosedForm) {
  const Capsule capsule{{0, 0, 0}, {0, 0, 1}, 0.25, {}};
  const double slanted = 5 - 0.25 * std::sqrt(2.0);
  const Shot shots[] = {
      {{3, 0, 0.5}, {-1, 0, 0}, 2.75, 1},        // the mantle, squarely
      {{3, 0.15, 0.5}, {-1, 0, 0}, 2.8, 0.8},    // 0.15 aside: 3-4-5
      {{3, 0.26, 0.5}, {-1, 0, 0}, -1, 0},       // past it
      {{0, 0, 4}, {0, 0, -1}, 2.75, 1},          // along the axis, upper end
      {{0, 0, -4}, {0, 0, 1}, 3.75, 1},          // and lower end
      {{3, 0, 1.2}, {-1, 0, 0}, 2.85, 0.6},      // the upper ball: 3-4-5
      {{3, 0, 1.26}, {-1, 0, 0}, -1, 0},         // over it
      {{5 * M_SQRT1_2, 0, 0.5 + 5 * M_SQRT1_2},  // down at 45 degrees
       {-M_SQRT1_2, 0, -M_SQRT1_2},
       slanted,
       M_SQRT1_2},
      {{3, 0, 0.5}, {1, 0, 0}, -1, 0},  // away from it
  };
  for (const Shot& shot : shots) {
    CapsuleHit hit{};
    const bool met = intersect(capsule, shot.origin, shot.direction, 0, 100, hit);
    ASSERT_EQ(met, shot.range >= 0) << shot.origin.transpose();
    if (!met) continue;
    EXPECT_NEAR(hit.range, shot.range, 1e-12);
    EXPECT_NEAR(hit.cos_incidence, shot.cosine, 1e-12);
    EXPECT_FALSE(intersect(capsule, shot.origin, shot.direction, 0, shot.range - 1e-9, hit));
  }
}

}  // namespace
}  // namespace holdfast::simulation
