#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulation/crowd/crowd.hpp"
#include "simulation/world/ray_caster.hpp"
#include "tests/simulation/support.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;
using testing::event;
using testing::make;
using testing::noise_free;
using testing::record;

/// Of what crowded() asks for, the time when all are there.
const TimeNs kBegin = densest({8 * kSecond, 20 * kSecond}).begin;
const TimeNs kEnd = densest({8 * kSecond, 20 * kSecond}).end;

SimulationOptions crowded(const std::string& scenario, std::uint64_t seed) {
  SimulationOptions options = noise_free(scenario, 40);
  options.seed = seed;
  options.lidar.columns = 300;
  options.events = {event("crowd@8+12")};
  return options;
}

/// Range at which the ray of a return meets the static world.
double static_range(const Simulation& simulation, const RayCaster& world, TimeNs t,
                    const ScanPoint& point) {
  const SE3 T_map_lidar = simulation.truth_at(t) * simulation.options().lidar.T_body_lidar;
  const Vector3d d = T_map_lidar.rotation * testing::position(point).normalized();
  RayPacket rays;
  rays.x.fill(static_cast<float>(T_map_lidar.translation.x()));
  rays.y.fill(static_cast<float>(T_map_lidar.translation.y()));
  rays.z.fill(static_cast<float>(T_map_lidar.translation.z()));
  rays.dx.fill(static_cast<float>(d.x()));
  rays.dy.fill(static_cast<float>(d.y()));
  rays.dz.fill(static_cast<float>(d.z()));
  HitPacket hits;
  world.cast(rays, 0.05F, 200, hits);
  return hits.range[0];
}

/// The share of the returns whose rays would reach 15 m at most and that come from people.
double hidden_share(const Simulation& simulation, const RayCaster& world, const Scan& scan) {
  double near = 0;
  double hidden = 0;
  for (const ScanPoint& point : scan.points) {
    const double there = static_range(simulation, world, scan.stamp + point.time_offset_ns, point);
    if (there > 15) continue;
    near += 1;
    hidden += testing::position(point).norm() < there - 0.05 ? 1 : 0;
  }
  return near > 0 ? hidden / near : 0;
}

struct Density {
  double most = 0;
  double mean = 0;
};

Density density(const std::string& scenario) {
  SimulationOptions options = crowded(scenario, 1);
  options.duration_s = 18.5;
  const auto simulation = make(options);
  const auto log = record(*simulation);
  const RayCaster world(simulation->scenario().world);
  Density out;
  int scans = 0;
  for (const Scan& scan : log.scans) {
    const TimeNs t = scan.stamp - simulation->start_time();
    if (t < kBegin || t + kSecond / 10 > kEnd) continue;
    const double share = hidden_share(*simulation, world, scan);
    out.most = std::max(out.most, share);
    out.mean += share;
    ++scans;
  }
  out.mean /= scans;
  return out;
}

TEST(Crowd, HidesMostOfWhatIsNear) {
  for (const char* scenario : {"corridor", "offices", "garage", "yard"}) {
    const Density d = density(scenario);
    RecordProperty(scenario, std::to_string(d.most) + " " + std::to_string(d.mean));
    EXPECT_GT(d.most, 0.55) << scenario;
    EXPECT_LT(d.most, 0.85) << scenario;
    EXPECT_GT(d.mean, 0.45) << scenario;
  }
}

class CrowdIn : public ::testing::TestWithParam<const char*> {
 protected:
  std::unique_ptr<Simulation> crowd_ = make(crowded(GetParam(), 2));
  std::unique_ptr<Simulation> plain_ = make(noise_free(GetParam(), 40));
  std::size_t first() const { return plain_->people().size(); }
  bool is_there(std::size_t person, TimeNs t) const { return crowd_->people().is_there(person, t); }
};

TEST_P(CrowdIn, PeopleKeepClearOfTheRobotAndMoveAsPeopleDo) {
  const Walkers& people = crowd_->people();
  EXPECT_GE(people.size(), first() + 8);
  const TimeNs start = crowd_->start_time();
  for (std::size_t i = first(); i < people.size(); ++i) {
    for (TimeNs t = 0; t < 40 * kSecond; t += kSecond / 20) {
      if (!is_there(i, t)) continue;
      const MotionState person = people.at(i, t);
      const Vector3d apart =
          person.T_map_body.translation - crowd_->truth_at(start + t).translation;
      if (std::abs(apart.z()) < 2) {
        ASSERT_GT(apart.head<2>().norm(), 0.5) << i;
      }
      ASSERT_LT(person.v_map.norm(), 3.2) << i << " " << to_seconds(t);
      ASSERT_LT(person.a_map.norm(), 8.0) << i << " " << to_seconds(t);
    }
  }
}

TEST_P(CrowdIn, PeopleComeAndGoWhereNobodySeesThemOrFarAway) {
  const RayCaster world(crowd_->scenario().world);
  const Walkers& people = crowd_->people();
  std::size_t changes = 0;
  for (std::size_t i = first(); i < people.size(); ++i) {
    for (TimeNs t = kSecond / 20; t < 40 * kSecond; t += kSecond / 20) {
      if (is_there(i, t) == is_there(i, t - kSecond / 20)) continue;
      ++changes;
      const Vector3d place = people.at(i, t).T_map_body.translation;
      const SE3 T_map_lidar =
          crowd_->truth_at(crowd_->start_time() + t) * crowd_->options().lidar.T_body_lidar;
      const Vector3d eye = T_map_lidar.translation;
      if ((place - eye).head<2>().norm() > 24.5) continue;
      for (const double height : {0.3, 0.9, 1.3, 1.65}) {
        const Vector3d part = place + Vector3d(0, 0, height);
        ASSERT_FALSE(world.is_visible(eye.cast<float>(), part.cast<float>()))
            << i << " at " << to_seconds(t) << " s, " << (place - eye).norm() << " m away";
      }
    }
  }
  EXPECT_GE(changes, people.size() - first()) << "most come, and most go";
}

TEST_P(CrowdIn, NobodyIsInAWallWhileItLasts) {
  const RayCaster world(crowd_->scenario().world);
  const Walkers& people = crowd_->people();
  for (std::size_t i = first(); i < people.size(); ++i) {
    for (TimeNs t = kBegin; t < kEnd; t += kSecond / 10) {
      const Vector3d a = people.at(i, t).T_map_body.translation + Vector3d(0, 0, 1.1);
      const Vector3d b =
          people.at(i, t + kSecond / 10).T_map_body.translation + Vector3d(0, 0, 1.1);
      if ((a - b).norm() < 0.01) continue;
      ASSERT_TRUE(world.is_visible(a.cast<float>(), b.cast<float>())) << i << " " << to_seconds(t);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Crowd, CrowdIn,
                         ::testing::Values("corridor", "offices", "garage", "yard", "office"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST(Crowd, LeavesTheNoiseAndTheBeginningOfTheDriveAsTheyAre) {
  SimulationOptions options = crowded("box", 3);
  const auto with = make(options);
  options.events.clear();
  const auto without = make(options);
  for (TimeNs t = 0; t < 6 * kSecond; t += kSecond / 10) {
    const TimeNs at = with->start_time() + t;
    ASSERT_EQ(with->truth_at(at).translation, without->truth_at(at).translation);
  }
}

}  // namespace
}  // namespace holdfast::simulation
