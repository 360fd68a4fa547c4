#include "simulation/truth/true_geometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "holdfast/core/random.hpp"
#include "simulation/truth/true_edges.hpp"
#include "simulation/world/world_builder.hpp"
#include "tests/simulation/support.hpp"
#include "tests/simulation/tolerances.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;
using testing::make;
using testing::noise_free;
using testing::position;
using testing::record;

constexpr double kFloat = 1e-5;  // vertices are floats of at most 12: 7e-7 each, summed over a few

double total(const std::vector<Segment>& edges) {
  double sum = 0;
  for (const Segment& edge : edges) sum += (edge.b - edge.a).norm();
  return sum;
}

double edge_length(WorldBuilder& build) { return total(true_edges(build.build())); }

TEST(TrueEdges, OfABoxAreItsTwelveInAnyAttitude) {
  WorldBuilder build;
  build.box({{3, 2, 1}, {1, 2, 3}, 0.7}, materials::kIdeal);
  const auto edges = true_edges(build.build());
  EXPECT_EQ(edges.size(), 12U);
  EXPECT_NEAR(total(edges), 4 * (1 + 2 + 3), kFloat);
}

// The panels beside and above a door touch along their sides; there the wall goes on.
TEST(TrueEdges, OfAWallWithADoorLeaveOutTheSeamsOfItsPanels) {
  WorldBuilder build;
  build.wall({{0, 0}, {4, 0}, 0, 2, materials::kIdeal, {{2.5, 1, 0, 1.5, 0.2}}});
  const double rim = 2 + 4 + 2 + (4 - 1);
  const double opening = 1.5 + 1 + 1.5;
  const double back = 1.5 + 1 + 1.5 + 1;
  const double reveals = 2 * 0.2 + 2 * 0.2;  // beside the head, and on the ground
  EXPECT_NEAR(edge_length(build), rim + opening + back + reveals, kFloat);
}

TEST(TrueEdges, WhereOneFaceEndsInTheMiddleOfAnothersSideOnlyThatPartIsShared) {
  WorldBuilder build;  // a floor, and a wall over the middle third of one of its sides
  build.floor({0, 0}, {3, 2}, 0, materials::kIdeal);
  build.wall({{1, 0}, {2, 0}, 0, 1, materials::kIdeal, {}});
  EXPECT_NEAR(edge_length(build), 2 * (3 + 2) + (1 + 1 + 1), kFloat);
}

TEST(TrueEdges, FloorsSideBySideAreOneFloor) {
  WorldBuilder build;
  build.floor({0, 0}, {3, 2}, 0, materials::kIdeal);
  build.floor({3, 0}, {5, 1.2}, 0, materials::kIdeal);
  build.floor({3, 1.2}, {5, 2}, 0, materials::kIdeal);
  EXPECT_NEAR(edge_length(build), 2 * (5 + 2), kFloat);
}

TEST(TrueEdges, RoundThingsHaveThemOnlyWhereFacetsMeetSharply) {
  const auto circle = [](int segments) {
    return segments * 2 * 0.5 * std::sin(std::numbers::pi / segments);
  };
  WorldBuilder fine;  // 11 degrees between facets
  fine.cylinder({1, 1, 0}, 0.5, 2, materials::kIdeal, 32);
  EXPECT_NEAR(edge_length(fine), 2 * circle(32), kFloat);
  WorldBuilder coarse;  // 30 degrees
  coarse.cylinder({1, 1, 0}, 0.5, 2, materials::kIdeal, 12);
  EXPECT_NEAR(edge_length(coarse), 2 * circle(12) + 12 * 2, kFloat);
}

TEST(TrueGeometry, NearestEdgeIsThatOfTheClosedForm) {
  const Scenario box = *make_scenario("box");
  const TrueGeometry geometry(box.world);
  RandomStream random(1, "points");
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p(random.uniform(0, 12), random.uniform(0, 8), random.uniform(0, 4));
    // An edge of the room runs along one axis at the nearer ends of the other two.
    const Vector3d to_wall = p.cwiseMin(Vector3d(12, 8, 4) - p);
    Vector3d distances;
    for (int k = 0; k < 3; ++k) {
      distances[k] = std::hypot(to_wall[(k + 1) % 3], to_wall[(k + 2) % 3]);
    }
    Eigen::Index along = 0;
    const double expected = std::min(distances.minCoeff(&along), TrueGeometry::kReach);
    const auto nearest = geometry.nearest_edge(p);
    ASSERT_NEAR(nearest.distance_m, expected, kFloat) << p.transpose();
    if (expected < TrueGeometry::kReach - kFloat) {
      ASSERT_NEAR(std::abs(nearest.along[along]), 1, kFloat) << p.transpose();
    } else {
      ASSERT_EQ(nearest.along.norm(), 0);
    }
  }
}

// Ranges are floats; in a world of up to 250 m origins and ranges carry 250 * 6e-8 each.
constexpr double kRayInWorld = 12 * 250 * 6e-8;

TEST(TrueGeometry, WithoutNoiseEachReturnLiesWhereItsRayMetTheWorld) {
  for (const char* name : {"box", "tunnel", "warehouse", "hall"}) {
    SimulationOptions options = noise_free(name, 3.5);
    options.wobble_rad = 0.05;
    const auto simulation = make(options);
    const Scan scan = record(*simulation).scans.back();
    const auto truth = simulation->true_geometry(scan);
    ASSERT_EQ(truth.size(), scan.points.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const SE3 T_map_lidar = simulation->truth_at(scan.stamp + scan.points[i].time_offset_ns) *
                              options.lidar.T_body_lidar;
      const Vector3d p = T_map_lidar * position(scan.points[i]);
      // Near a silhouette the ray cast again may meet what is next to it: not once in these worlds.
      const double off = std::abs(truth[i].normal_map.dot(p - truth[i].point_map));
      ASSERT_LT(off, kRayInWorld) << name << " point " << i;
      ASSERT_LE(truth[i].normal_map.dot(p - T_map_lidar.translation), 0) << "faces the LiDAR";
      ASSERT_NEAR(truth[i].normal_map.norm(), 1, 1e-6);
      ASSERT_FALSE(truth[i].moving);
    }
  }
}

TEST(TrueGeometry, NoiseLiesAlongTheRayAndLeavesTheTruthWhereItIs) {
  SimulationOptions options = noise_free("box", 3.5);
  options.lidar.range_sigma_m = 0.02;
  const auto simulation = make(options);
  const Scan scan = record(*simulation).scans.back();
  const auto truth = simulation->true_geometry(scan);
  double squares = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const SE3 T_map_lidar = simulation->truth_at(scan.stamp + scan.points[i].time_offset_ns) *
                            options.lidar.T_body_lidar;
    const Vector3d true_ray = truth[i].point_map - T_map_lidar.translation;
    squares += std::pow(position(scan.points[i]).norm() - true_ray.norm(), 2);
    const Vector3d p = truth[i].point_map;
    const Vector3d to_wall = p.cwiseMin(Vector3d(12, 8, 4) - p);
    ASSERT_NEAR(to_wall.minCoeff(), 0, kRayInWorld) << "on a wall";
  }
  const double n = static_cast<double>(truth.size());
  EXPECT_NEAR(squares / n / (0.02 * 0.02), 1, tolerances::variance_error(n));
}

TEST(TrueGeometry, KnowsReturnsFromPeople) {
  const auto simulation = make(noise_free("office", 6));
  std::size_t people = 0;
  std::size_t off = 0;
  for (const Scan& scan : record(*simulation).scans) {
    const auto truth = simulation->true_geometry(scan);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (!truth[i].moving) continue;
      ++people;
      const SE3 T_map_lidar = simulation->truth_at(scan.stamp + scan.points[i].time_offset_ns) *
                              simulation->options().lidar.T_body_lidar;
      const Vector3d p = T_map_lidar * position(scan.points[i]);
      // The sensor moves a leg on as a whole for up to 1.1 ms, with the velocity of its middle; a
      // foot swings up to 0.9 m/s faster than that: 1 mm, which a ray that grazes the leg's rim
      // (2 % of the width lie within that of one) turns into more.
      off += std::abs(truth[i].normal_map.dot(p - truth[i].point_map)) > 1e-3 ? 1 : 0;
      ASSERT_EQ(truth[i].edge_distance_m, TrueGeometry::kReach);
    }
  }
  EXPECT_GT(people, 1000U);
  EXPECT_LT(off, people / 50);
}

}  // namespace
}  // namespace holdfast::simulation
