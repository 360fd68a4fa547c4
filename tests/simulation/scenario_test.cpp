#include "simulation/scenario.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/change/world_change.hpp"
#include "simulation/world/ray_caster.hpp"
#include "tests/simulation/support.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::make;
using testing::record;

/// Distance from `p` to the nearest surface around it at the same height.
double clearance(const RayCaster& caster, const Vector3d& p) {
  double least = 100;
  HitPacket hits;
  for (int packet = 0; packet < 4; ++packet) {
    RayPacket rays{};
    for (int i = 0; i < RayPacket::kSize; ++i) {
      const double angle = 2 * std::numbers::pi * (packet * RayPacket::kSize + i) / 32;
      rays.x[i] = static_cast<float>(p.x());
      rays.y[i] = static_cast<float>(p.y());
      rays.z[i] = static_cast<float>(p.z());
      rays.dx[i] = static_cast<float>(std::cos(angle));
      rays.dy[i] = static_cast<float>(std::sin(angle));
    }
    caster.cast(rays, 0, 100, hits);
    for (const float range : hits.range) least = std::min(least, static_cast<double>(range));
  }
  return least;
}

std::vector<TimeNs> kidnaps_every_ten_seconds() {
  std::vector<TimeNs> out;
  for (int i = 1; i < 9; ++i) out.push_back(i * 10 * kSecond);
  return out;
}

/// Spare things are in the worlds of scenarios, so that what may come keeps clear too.
TEST(Scenario, RobotsKeepClearOfEverything) {
  for (const ScenarioInfo& info : scenarios()) {
    const Scenario scenario = info.make();
    EXPECT_EQ(scenario.name, info.name);
    const RayCaster caster(scenario.world);
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const bool kidnapped = seed > 3;
      const Drive drive =
          Drive::plan(scenario.route, scenario.style, seed, 90 * kSecond,
                      kidnapped ? kidnaps_every_ten_seconds() : std::vector<TimeNs>{});
      for (TimeNs t = 0; t < drive.duration(); t += kSecond / 5) {
        const Vector3d body = drive.at(t).T_map_body.translation;
        const double ground = body.z() - scenario.style.body_height_m;
        for (const double height : {0.3, 0.6, 1.0}) {
          ASSERT_GT(clearance(caster, {body.x(), body.y(), ground + height}), 0.3)
              << info.name << " seed " << seed << " at " << to_seconds(t) << " s, ("
              << body.transpose() << ")";
        }
      }
    }
  }
}

TEST(Scenario, RobotsKeepClearInChangedWorlds) {
  for (const char* name : {"office", "offices", "yard", "warehouse", "lift", "town"}) {
    const Scenario scenario = *make_scenario(name);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const auto changed = change_world(scenario, 0.5, seed);
      ASSERT_TRUE(changed) << changed.error().message;
      const RayCaster caster(changed->after);
      const Drive drive = Drive::plan(scenario.route, scenario.style, seed, std::nullopt, {});
      for (TimeNs t = 0; t < drive.duration(); t += kSecond / 5) {
        const Vector3d body = drive.at(t).T_map_body.translation;
        const double ground = body.z() - scenario.style.body_height_m;
        for (const double height : {0.3, 0.6, 1.0}) {
          ASSERT_GT(clearance(caster, {body.x(), body.y(), ground + height}), 0.3)
              << name << " seed " << seed << " at " << body.transpose();
        }
      }
    }
  }
}

void expect_polite_people(const Scenario& scenario, std::uint64_t seed) {
  const RayCaster caster(scenario.world);
  const Drive robot = Drive::plan(scenario.route, scenario.style, seed, std::nullopt, {});
  const Walkers people(scenario.walkers, robot, seed);
  std::vector<double> way(people.size());
  for (TimeNs t = 0; t < robot.duration(); t += kSecond / 10) {
    const Vector2d body = robot.at(t).T_map_body.translation.head<2>();
    for (std::size_t i = 0; i < people.size(); ++i) {
      const MotionState person = people.at(i, t);
      const Vector2d p = person.T_map_body.translation.head<2>();
      ASSERT_GT((p - body).norm(), 0.6) << i << ": " << p.transpose();
      ASSERT_LT(person.v_map.norm(), 1.05);
      ASSERT_GT(clearance(caster, {p.x(), p.y(), 1.2}), 0.15) << i << ": " << p.transpose();
      way[i] += 0.1 * person.v_map.norm();
      for (std::size_t k = 0; k < i; ++k) {
        const Vector2d q = people.at(k, t).T_map_body.translation.head<2>();
        ASSERT_GT((p - q).norm(), 0.4) << i << " and " << k << ": " << p.transpose();
      }
    }
  }
  for (std::size_t i = 0; i < people.size(); ++i) {
    const double mean = way[i] / to_seconds(robot.duration());
    EXPECT_GT(mean, 0.7 * scenario.walkers[i].speed_m_s) << "person " << i << ", seed " << seed;
  }
}

TEST(Scenario, PeopleWalkAtTheirPaceAndKeepAway) {
  for (const auto& [name, people] : {std::pair("office", 5U), std::pair("offices", 7U)}) {
    const Scenario scenario = *make_scenario(name);
    ASSERT_EQ(scenario.walkers.size(), people);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) expect_polite_people(scenario, seed);
  }
}

/// Mean, median, least and most returns of a revolution over a drive of 40 s, one revolution a
/// second.
struct Returns {
  double mean = 0;
  std::size_t median = 0;
  std::size_t least = 1'000'000;
  std::size_t most = 0;
};

Returns returns_in(const char* scenario, std::uint64_t seed) {
  SimulationOptions options;
  options.scenario = scenario;
  options.seed = seed;
  options.duration_s = 40;
  options.lidar.period = kSecond;
  options.threads = 2;
  Returns out;
  std::vector<std::size_t> counts;
  const auto log = record(*make(options));
  for (const Scan& scan : log.scans) {
    out.mean += static_cast<double>(scan.points.size()) / static_cast<double>(log.scans.size());
    out.least = std::min(out.least, scan.points.size());
    out.most = std::max(out.most, scan.points.size());
    counts.push_back(scan.points.size());
  }
  std::sort(counts.begin(), counts.end());
  out.median = counts[counts.size() / 2];
  return out;
}

/// But for the lobby, where it returns next to none.
TEST(Scenario, TheHallReturnsAboutThreeThousandPoints) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Returns hall = returns_in("hall", seed);
    EXPECT_GT(hall.median, 2700U);
    EXPECT_LT(hall.median, 3700U);
    EXPECT_LT(hall.least, 300U);
    EXPECT_LT(hall.most, 5500U);
  }
}

TEST(Scenario, CorridorAndOfficesReturnNearlyEveryRay) {
  for (const char* name : {"corridor", "office", "offices"})
    EXPECT_GT(returns_in(name, 1).mean, 28000) << name;
}

TEST(Scenario, WaysAreAsLongAsTheArticleSays) {
  EXPECT_NEAR(make_scenario("corridor")->route.length(), 100, 3);
  EXPECT_EQ(make_scenario("corridor")->style.distance_m, 100);
  EXPECT_EQ(make_scenario("office")->style.distance_m, 200);
  EXPECT_EQ(make_scenario("hall")->style.distance_m, 150);
  EXPECT_NEAR(make_scenario("campus")->route.length(), 1910, 1);
  EXPECT_EQ(make_scenario("campus")->style.distance_m, 1910);
}

/// 360 m of fire lane, 100 m of walkway, 50 m of plaza and 140 m of street, there and back.
TEST(Scenario, TheCampusGoesThroughItsFourRegions) {
  const Scenario campus = *make_scenario("campus");
  const std::vector<std::pair<std::string, double>> lengths = {
      {"fire lane", 360}, {"walkway", 100}, {"plaza", 50}, {"street", 140}};
  ASSERT_EQ(campus.regions.size(), lengths.size());
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const Region& region = campus.regions[i];
    EXPECT_EQ(region.name, lengths[i].first);
    double within = 0;
    for (double s = 0; s < campus.route.length(); s += 0.1) {
      const Vector2d p = campus.route.at(s).position.head<2>();
      const bool in = (p - region.min).minCoeff() >= 0 && (region.max - p).minCoeff() >= 0;
      within += in ? 0.1 : 0;
    }
    EXPECT_NEAR(within, 2 * lengths[i].second, 8) << region.name;
  }
}

void expect_polite_vehicles(const Scenario& scenario, std::uint64_t seed) {
  const Drive robot = Drive::plan(scenario.route, scenario.style, seed, 300 * kSecond, {});
  const Walkers people(scenario.walkers, robot, seed);
  std::vector<Material> materials;
  const Movers vehicles(drive_vehicles(scenario.vehicles, robot, people, seed), materials);
  EXPECT_GE(2 * vehicles.size(), scenario.vehicles.size()) << scenario.name << " seed " << seed;
  const RayCaster caster(scenario.world);
  for (TimeNs t = 0; t < robot.duration(); t += kSecond / 5) {
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      const SE3 pose = vehicles.at(i, t).T_map_body;
      const Vector3d robot_there = pose.inverse() * robot.at(t).T_map_body.translation;
      const Vector2d half = 0.5 * vehicles.boxes(i).front().size.head<2>();
      ASSERT_GT((robot_there.head<2>().cwiseAbs() - half).cwiseMax(0).norm(), 0.95);
      ASSERT_GT(clearance(caster, pose.translation + Vector3d(0, 0, 0.5)), half.y())
          << scenario.name << ": " << pose.translation.transpose();
    }
  }
}

TEST(Scenario, VehiclesKeepOffTheRobotAndOffWalls) {
  for (const char* name : {"campus", "town"}) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      expect_polite_vehicles(*make_scenario(name), seed);
    }
  }
}

TEST(Scenario, AnUnknownNameIsAnErrorWithTheKnownOnes) {
  const auto scenario = make_scenario("moon");
  ASSERT_FALSE(scenario);
  for (const ScenarioInfo& info : scenarios()) {
    EXPECT_THAT(scenario.error().message, ::testing::HasSubstr(std::string(info.name)));
  }
}

}  // namespace
}  // namespace holdfast::simulation
