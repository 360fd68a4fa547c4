#include "simulation/change/world_change.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "simulation/world/world_builder.hpp"
#include "tests/simulation/support.hpp"
#include "tests/simulation/tolerances.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::AlignedBox3f;
using Eigen::Vector3f;
using testing::make;
using testing::noise_free;
using testing::position;
using testing::record;

const std::vector<const char*> kChangeable = {"corridor", "office", "hall",   "warehouse",
                                              "yard",     "tunnel", "offices"};

/// Corners of the triangles of each object, or of the structure under 0.
std::map<std::size_t, std::vector<Vector3f>> corners_by_object(const World& world) {
  std::map<std::size_t, std::vector<Vector3f>> out;
  for (std::size_t i = 0; i < world.triangles.size(); ++i) {
    auto& corners = out[world.object_of[i]];
    for (const std::uint32_t k : world.triangles[i]) corners.push_back(world.vertices[k]);
  }
  return out;
}

AlignedBox3f bounds(const std::vector<Vector3f>& points) {
  AlignedBox3f box;
  for (const Vector3f& p : points) box.extend(p);
  return box;
}

ChangedWorld changed(const Scenario& scenario, double share, std::uint64_t seed) {
  auto change = change_world(scenario, share, seed);
  if (!change) ADD_FAILURE() << change.error().message;
  return std::move(*change);
}

TEST(WorldChange, TheWorldDiffersInTheShareAskedForAndItsStructureDoesNot) {
  for (const char* name : kChangeable) {
    const Scenario scenario = *make_scenario(name);
    const std::size_t n = scenario.world.objects.size();
    for (const double share : {0.0, 0.2, 0.5, 1.0}) {
      const ChangedWorld change = changed(scenario, share, 3);
      auto before = corners_by_object(change.before);
      auto after = corners_by_object(change.after);
      EXPECT_EQ(before[0], after[0]) << name;
      std::size_t different = 0;
      for (std::size_t k = 1; k <= n; ++k) different += before[k] != after[k] ? 1 : 0;
      EXPECT_EQ(different, std::lround(share * static_cast<double>(n))) << name;
      EXPECT_EQ(different, change.changes.size()) << name;
    }
  }
}

/// What one change did to one object, as seen in the two worlds.
void expect_change(const ObjectChange& change, const WorldObject& object,
                   const std::vector<Vector3f>& before, const std::vector<Vector3f>& after) {
  switch (change.kind) {
    case ChangeKind::kRemoved:
      EXPECT_FALSE(before.empty());
      EXPECT_TRUE(after.empty());
      EXPECT_FALSE(object.spare);
      return;
    case ChangeKind::kAdded:
      EXPECT_TRUE(before.empty());
      EXPECT_FALSE(after.empty());
      return;
    case ChangeKind::kMoved: break;
  }
  EXPECT_FALSE(object.mounted || object.spare) << object.name;
  ASSERT_EQ(before.size(), after.size());
  const Eigen::Vector3f step = bounds(after).center() - bounds(before).center();
  // A box that turns by up to 0.6 rad about the middle of its bounds keeps that middle to within
  // the asymmetry of what stands in it.
  EXPECT_GT(step.norm(), 0.1);
  EXPECT_LT(step.norm(), 2.5 + 0.5);
  for (std::size_t i = 1; i < before.size(); ++i) {
    EXPECT_NEAR((after[i] - after[0]).norm(), (before[i] - before[0]).norm(), 1e-4) << "rigid";
    EXPECT_NEAR(after[i].z(), before[i].z(), 1e-4) << "on the ground";
  }
}

TEST(WorldChange, ObjectsAreMovedGoOrComeAsTheListSays) {
  std::map<ChangeKind, int> kinds;
  for (const char* name : kChangeable) {
    const Scenario scenario = *make_scenario(name);
    const ChangedWorld change = changed(scenario, 0.6, 7);
    auto before = corners_by_object(change.before);
    auto after = corners_by_object(change.after);
    for (const ObjectChange& c : change.changes) {
      expect_change(c, scenario.world.objects[c.object], before[c.object + 1], after[c.object + 1]);
      ++kinds[c.kind];
    }
  }
  for (const auto kind : {ChangeKind::kMoved, ChangeKind::kRemoved, ChangeKind::kAdded}) {
    EXPECT_GT(kinds[kind], 20);
  }
}

TEST(WorldChange, WhatIsMovedStandsInNothingElse) {
  int moved = 0;
  for (const char* name : {"office", "offices", "yard"}) {
    const Scenario scenario = *make_scenario(name);
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const ChangedWorld change = changed(scenario, 0.4, seed);
      auto after = corners_by_object(change.after);
      for (const ObjectChange& c : change.changes) {
        if (c.kind != ChangeKind::kMoved) continue;
        ++moved;
        const AlignedBox3f there = bounds(after[c.object + 1]);
        for (const auto& [object, corners] : after) {
          if (object == 0 || object == c.object + 1) continue;
          EXPECT_FALSE(there.intersects(bounds(corners)))
              << name << ": " << scenario.world.objects[c.object].name << " in "
              << scenario.world.objects[object - 1].name;
        }
      }
    }
  }
  EXPECT_GT(moved, 30);
}

TEST(WorldChange, SpareThingsAreNotThereUntilTheyCome) {
  WorldBuilder build;
  build.floor({0, 0}, {4, 4}, 0, materials::kIdeal);
  build.spare([&] {
    build.object({"crate"}, [&] { build.box({{2, 2, 0.5}, {1, 1, 1}}, materials::kWood); });
  });
  build.object({"cup"}, [&] { build.box({{1, 1, 0.5}, {1, 1, 1}}, materials::kWood); });
  const World all = build.build();
  ASSERT_EQ(all.objects.size(), 2U);
  EXPECT_TRUE(all.objects[0].spare);
  EXPECT_FALSE(all.objects[1].spare);
  const auto first = corners_by_object(unchanged_world(all));
  EXPECT_EQ(first.count(1), 0U);
  EXPECT_EQ(first.count(2), 1U);
}

TEST(WorldChange, IsTheSameForOneSeedAndAnotherForEach) {
  const Scenario scenario = *make_scenario("offices");
  const auto list = [&](std::uint64_t seed) {
    std::vector<std::pair<std::size_t, ChangeKind>> out;
    for (const auto& c : changed(scenario, 0.3, seed).changes) out.emplace_back(c.object, c.kind);
    return out;
  };
  EXPECT_EQ(list(1), list(1));
  EXPECT_NE(list(1), list(2));
  EXPECT_EQ(changed(scenario, 0.3, 1).after.vertices, changed(scenario, 0.3, 1).after.vertices);
}

TEST(WorldChange, AWorldWithoutObjectsIsAnError) {
  const auto change = change_world(*make_scenario("box"), 0.2, 1);
  ASSERT_FALSE(change);
  EXPECT_THAT(change.error().message, ::testing::HasSubstr("scenario 'box'"));
}

/// How many of the points lie in the box, above the ground.
std::size_t inside(const AlignedBox3f& box, const std::vector<Vector3f>& points) {
  return static_cast<std::size_t>(std::count_if(points.begin(), points.end(), [&](const auto& p) {
    return p.z() > 0.1F && box.contains(p);
  }));
}

// Cars stand free: what the survey or a scan shows within their bounds is theirs.
TEST(WorldChange, TheSurveySeesTheWorldBeforeAndTheDriveTheWorldAfter) {
  SimulationOptions options = noise_free("yard", 8);
  options.changed_share = 0.7;
  options.map_sigma_m = 0;
  const auto simulation = make(options);
  const ChangedWorld change = changed(*make_scenario("yard"), 0.7, options.seed);
  ASSERT_EQ(simulation->changes().size(), change.changes.size());
  const auto map = simulation->survey_map().points;
  std::vector<Vector3f> seen;
  for (const Scan& scan : record(*simulation).scans) {
    for (const auto& truth : simulation->true_geometry(scan)) {
      if (!truth.moving) seen.push_back(truth.point_map.cast<float>());
    }
  }
  auto before = corners_by_object(change.before);
  auto after = corners_by_object(change.after);
  int seen_new = 0;
  for (const ObjectChange& c : change.changes) {
    if (c.kind == ChangeKind::kRemoved) {
      EXPECT_GT(inside(bounds(before[c.object + 1]), map), 100U);
      EXPECT_EQ(inside(bounds(before[c.object + 1]), seen), 0U);
    }
    if (c.kind == ChangeKind::kAdded) {
      EXPECT_EQ(inside(bounds(after[c.object + 1]), map), 0U);
      seen_new += inside(bounds(after[c.object + 1]), seen) > 100 ? 1 : 0;
    }
  }
  EXPECT_GT(seen_new, 2);
}

}  // namespace
}  // namespace holdfast::simulation
