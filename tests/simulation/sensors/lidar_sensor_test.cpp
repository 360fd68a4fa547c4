#include "simulation/sensors/lidar/lidar_sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "tests/simulation/support.hpp"
#include "tests/simulation/tolerances.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;
using testing::make;
using testing::noise_free;
using testing::position;
using testing::record;

const Vector3d kRoom(12, 8, 4);

/// Distance from a point to the nearest wall of the box world.
double wall_distance(const Vector3d& p) {
  double least = 1e9;
  for (int k = 0; k < 3; ++k) {
    least = std::min({least, std::abs(p[k]), std::abs(p[k] - kRoom[k])});
  }
  return least;
}

double box_range(const Vector3d& origin, const Vector3d& direction) {
  double range = 1e9;
  for (int k = 0; k < 3; ++k) {
    if (direction[k] > 0) range = std::min(range, (kRoom[k] - origin[k]) / direction[k]);
    if (direction[k] < 0) range = std::min(range, -origin[k] / direction[k]);
  }
  return range;
}

/// Each point put into the map by the true pose at its own time lies on a wall.
void expect_on_walls(Simulation& simulation, const std::vector<Scan>& scans) {
  const SE3& T_body_lidar = simulation.options().lidar.T_body_lidar;
  double worst = 0;
  for (const Scan& scan : scans) {
    ASSERT_EQ(scan.points.size(), 28800U);
    for (const ScanPoint& point : scan.points) {
      const SE3 T_map_body = simulation.truth_at(scan.stamp + point.time_offset_ns);
      worst = std::max(worst, wall_distance(T_map_body * (T_body_lidar * position(point))));
    }
  }
  EXPECT_LT(worst, tolerances::kRayInRoom);
}

TEST(LidarSensor, AtRestMeasuresTheRoomInClosedForm) {
  const auto simulation = make(noise_free("box", 1));
  const auto log = record(*simulation);
  ASSERT_GE(log.scans.size(), 8U);
  expect_on_walls(*simulation, log.scans);
  const SE3 T_map_lidar =
      simulation->truth_at(simulation->start_time()) * simulation->options().lidar.T_body_lidar;
  for (const ScanPoint& point : log.scans[3].points) {
    const Vector3d p = position(point);
    const Vector3d direction = T_map_lidar.rotation * p.normalized();
    // The direction of the stored point is rounded; seen at the wall that is the point's rounding
    // divided by the cosine of incidence, at least 0.1 here.
    ASSERT_NEAR(p.norm(), box_range(T_map_lidar.translation, direction),
                10 * tolerances::kRayInRoom);
  }
}

// A ray that is cast from a pose 3 us too old is off by more than the tolerance in this drive.
TEST(LidarSensor, MovingCastsEachRayAtItsOwnTime) {
  SimulationOptions options = noise_free("box", 8);
  options.seed = 4;
  const auto simulation = make(options);
  auto log = record(*simulation);
  double fastest_turn = 0;
  for (const Scan& scan : log.scans) {
    fastest_turn = std::max(fastest_turn, simulation->state_at(scan.stamp).omega_body.norm());
  }
  ASSERT_GT(fastest_turn, 0.5);
  log.scans.erase(log.scans.begin(), log.scans.begin() + 50);
  expect_on_walls(*simulation, log.scans);
}

TEST(LidarSensor, MayBeMountedAnyWayRound) {
  SimulationOptions options = noise_free("box", 8);
  options.lidar.T_body_lidar.translation = {-0.2, 0.3, 0.4};
  options.lidar.T_body_lidar.rotation = so3::exp(Eigen::Vector3d(1.2, -0.7, 2.0));
  const auto simulation = make(options);
  auto log = record(*simulation);
  log.scans.erase(log.scans.begin(), log.scans.begin() + 50);
  expect_on_walls(*simulation, log.scans);
}

TEST(LidarSensor, FiresItsBeamsInOrderWhileTheHeadTurns) {
  const auto simulation = make(noise_free("box", 1));
  const auto log = record(*simulation);
  const Scan& scan = log.scans[0];
  EXPECT_TRUE(scan.has_ring);
  EXPECT_TRUE(scan.has_point_times);
  const std::uint16_t order[] = {0, 1, 2, 3, 4, 5, 6, 7, 15, 14, 13, 12, 11, 10, 9, 8};
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const ScanPoint& point = scan.points[i];
    const auto column = static_cast<TimeNs>(i / 16);
    const TimeNs fired = column * 100'000'000 / 1800 + static_cast<TimeNs>(i % 16) * 2800;
    ASSERT_EQ(point.time_offset_ns, fired);
    ASSERT_EQ(point.ring, order[i % 16]);
    const Vector3d p = position(point);
    const double elevation = std::asin(p.z() / p.norm()) * 180 / std::numbers::pi;
    ASSERT_NEAR(elevation, -15 + 2 * point.ring, 1e-4);
    const double azimuth = -2 * std::numbers::pi * static_cast<double>(fired) * 1e-8;
    ASSERT_NEAR(std::remainder(std::atan2(p.y(), p.x()) - azimuth, 2 * std::numbers::pi), 0, 1e-6);
  }
}

TEST(LidarSensor, StampsAreThoseOfFirstAndLastPoint) {
  SimulationOptions options = noise_free("hall", 4);
  const auto simulation = make(options);
  const auto log = record(*simulation);
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    const Scan& scan = log.scans[i];
    ASSERT_FALSE(scan.points.empty());
    EXPECT_EQ(scan.points.front().time_offset_ns, 0);
    EXPECT_EQ(scan.end_time, scan.stamp + scan.points.back().time_offset_ns);
    for (std::size_t k = 1; k < scan.points.size(); ++k) {
      ASSERT_GT(scan.points[k].time_offset_ns, scan.points[k - 1].time_offset_ns);
    }
    ASSERT_TRUE(i == 0 || scan.stamp > log.scans[i - 1].end_time);
  }
}

TEST(LidarSensor, RangeNoiseIsWhiteAndOfItsSigma) {
  SimulationOptions options = noise_free("box", 1);
  const auto exact = record(*make(options));
  options.lidar.range_sigma_m = 0.02;
  const auto noisy = record(*make(options));
  ASSERT_EQ(exact.scans.size(), noisy.scans.size());
  double sum = 0;
  double squares = 0;
  double next_ray = 0;
  double next_scan = 0;
  double n = 0;
  const auto error = [&](std::size_t scan, std::size_t i) {
    return position(noisy.scans[scan].points[i]).norm() -
           position(exact.scans[scan].points[i]).norm();
  };
  for (std::size_t scan = 1; scan < noisy.scans.size(); ++scan) {
    ASSERT_EQ(noisy.scans[scan].points.size(), exact.scans[scan].points.size());
    for (std::size_t i = 1; i < noisy.scans[scan].points.size(); ++i) {
      const double e = error(scan, i);
      sum += e;
      squares += e * e;
      next_ray += e * error(scan, i - 1);
      next_scan += e * error(scan - 1, i);
      ++n;
    }
  }
  const double variance = 0.02 * 0.02;
  EXPECT_NEAR(sum / n, 0, tolerances::mean_error(0.02, n));
  EXPECT_NEAR(squares / n / variance, 1, tolerances::variance_error(n));
  EXPECT_NEAR(next_ray / n / variance, 0, tolerances::mean_error(1, n));
  EXPECT_NEAR(next_scan / n / variance, 0, tolerances::mean_error(1, n));
}

TEST(LidarSensor, SurfacesReturnAsOftenAsTheirMaterialSays) {
  const auto run = [](bool all) {
    SimulationOptions options = noise_free("hall", 1);
    options.lidar.keep_all_returns = all;
    return record(*make(options));
  };
  const auto all = run(true);
  const auto some = run(false);
  EXPECT_EQ(all.scans[2].points.size(), 28800U) << "the hall is closed";
  // Counts of the same scene at rest scatter by less than sqrt(count).
  const auto count = static_cast<double>(some.scans[1].points.size());
  for (const Scan& scan : some.scans) {
    EXPECT_NEAR(static_cast<double>(scan.points.size()), count, 7 * std::sqrt(count));
  }
}

/// A point is explained by the static world or stands in front of it, where a person was.
TEST(LidarSensor, SeesPeopleWhereTheyAreAtTheTimeOfTheRay) {
  SimulationOptions options = noise_free("office", 6);
  options.lidar.keep_all_returns = true;
  const auto with = make(options);
  Scenario empty = *make_scenario("office");
  const auto plans = empty.walkers;
  const Drive robot = Drive::plan(empty.route, empty.style, options.seed, 6 * kSecond, {});
  const Walkers people(plans, robot, options.seed);
  empty.walkers.clear();
  const auto without = std::move(*Simulation::create(std::move(empty), options));
  const auto seen = record(*with);
  const auto bare = record(*without);
  std::size_t on_people = 0;
  std::vector<Capsule> shapes;
  for (std::size_t s = 0; s < seen.scans.size(); s += 3) {
    ASSERT_EQ(seen.scans[s].points.size(), bare.scans[s].points.size());
    for (std::size_t i = 0; i < seen.scans[s].points.size(); ++i) {
      const ScanPoint& point = seen.scans[s].points[i];
      const double nearer = position(bare.scans[s].points[i]).norm() - position(point).norm();
      if (nearer == 0) continue;
      ASSERT_GT(nearer, 0);
      ++on_people;
      const TimeNs t = seen.scans[s].stamp + point.time_offset_ns;
      const Vector3d p = with->truth_at(t) * (options.lidar.T_body_lidar * position(point));
      people.shapes_at(t - with->start_time(), shapes);
      double distance = 1e9;
      for (const Capsule& c : shapes) {
        const double u = std::clamp((p - c.a).dot(c.b - c.a) / (c.b - c.a).squaredNorm(), 0.0, 1.0);
        distance = std::min(distance, std::abs((p - c.a - u * (c.b - c.a)).norm() - c.radius));
      }
      // Shapes are taken every 2.2 ms and moved on steadily; feet swing with up to 1.4 m/s at the
      // ends, twice the steady motion of their middles, and 8 m/s^2.
      ASSERT_LT(distance, 0.0025);
    }
  }
  EXPECT_GT(on_people, 5000U);
}

}  // namespace
}  // namespace holdfast::simulation
