#include "simulation/sensors/gnss/gnss_receiver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/simulation/support.hpp"
#include "tests/simulation/tolerances.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;
/// The earth is 6.4e6 m large, angles and metres are doubles: some roundings of 1e-9 m.
constexpr double kOnEarth = 2e-8;

TEST(MapDatum, LeadsThereAndBack) {
  const MapDatum datum;
  for (const Vector3d& p : {Vector3d(0, 0, 0), Vector3d(100, -200, 30), Vector3d(-5e4, 3e4, 800)}) {
    EXPECT_LT((datum.to_map(datum.to_geodetic(p)) - p).norm(), kOnEarth);
  }
  const GeodeticPosition origin = datum.to_geodetic(Vector3d::Zero());
  EXPECT_NEAR(origin.latitude_deg, 50, 1e-14 / kDegree);
  EXPECT_NEAR(origin.longitude_deg, 10, 1e-14 / kDegree);
  EXPECT_NEAR(origin.altitude_m, 200, kOnEarth);
}

/// A metre north and a metre east in degrees, by the ellipsoid's radii of curvature.
TEST(MapDatum, ItsXPointsEastAndItsYNorth) {
  const double s2 = std::pow(std::sin(50 * kDegree), 2);
  const double e2 = 0.00669437999014;
  const double across_m = 6378137 / std::sqrt(1 - e2 * s2);
  const double along_m = across_m * (1 - e2) / (1 - e2 * s2);
  const GeodeticPosition place = MapDatum().to_geodetic({1, 1, 0});
  // Second-order terms: a metre over the earth's radius, twice.
  EXPECT_NEAR((place.latitude_deg - 50) * kDegree * (along_m + 200), 1, 1e-6);
  EXPECT_NEAR((place.longitude_deg - 10) * kDegree * (across_m + 200) * std::cos(50 * kDegree), 1,
              1e-6);
}

struct Errors {
  Vector3d squares = Vector3d::Zero();
  double count = 0;
};

void expect_sigma(const Errors& errors, double sigma) {
  const Vector3d relative = errors.squares / errors.count / (sigma * sigma);
  EXPECT_NEAR(relative.x(), 1, tolerances::variance_error(errors.count));
  EXPECT_NEAR(relative.y(), 1, tolerances::variance_error(errors.count));
  EXPECT_NEAR(relative.z(), 4, 4 * tolerances::variance_error(errors.count));
}

TEST(GnssReceiver, IsAsGoodAsItSaysAtRestAndMoving) {
  Errors rest;
  Errors moving;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SimulationOptions options = testing::noise_free("yard", 30);
    options.lidar.columns = 1;
    options.seed = seed;
    options.gnss.emplace();
    const auto simulation = testing::make(options);
    for (const GnssSample& sample : simulation->gnss_samples()) {
      if (!sample.has_fix) continue;
      const SE3 T_map_body = simulation->truth_at(sample.t);
      const Vector3d p_map = options.gnss->datum.to_map(
          {sample.latitude_deg, sample.longitude_deg, sample.altitude_m});
      const Vector3d error = p_map - T_map_body * Vector3d(0, 0, 0.3);
      const bool is_moving = sample.sigma_enu_m.x() > 0.03;
      // The antenna sways by some mm/s beside the body, so close to the limit either may be.
      const double speed = simulation->state_at(sample.t).v_map.norm();
      EXPECT_TRUE(std::abs(speed - 0.05) < 0.03 || is_moving == (speed > 0.05)) << speed;
      Errors& errors = is_moving ? moving : rest;
      errors.squares += error.cwiseAbs2();
      ++errors.count;
    }
  }
  ASSERT_GT(rest.count, 100);
  expect_sigma(rest, 0.02);
  expect_sigma(moving, 0.05);
}

TEST(GnssReceiver, HasNoFixInOutages) {
  SimulationOptions options = testing::noise_free("yard", 120);
  options.lidar.columns = 1;
  options.gnss.emplace();
  options.gnss->outages_per_minute = 6;
  const auto simulation = testing::make(options);
  const auto samples = simulation->gnss_samples();
  EXPECT_EQ(samples.size(), 1201U);
  const GnssReceiver receiver(*options.gnss, options.seed, 120 * kSecond);
  ASSERT_GT(receiver.outages().size(), 4U);
  for (const GnssSample& sample : samples) {
    bool out = false;
    for (const TimeSpan& span : receiver.outages()) {
      out = out || span.contains(sample.t - simulation->start_time());
    }
    ASSERT_EQ(sample.has_fix, !out);
    ASSERT_EQ(std::isnan(sample.latitude_deg), out);
  }
}

TEST(GnssReceiver, OutagesDoNotChangeTheNoiseOfOtherFixes) {
  SimulationOptions options = testing::noise_free("yard", 30);
  options.lidar.columns = 1;
  options.gnss.emplace();
  options.gnss->outages_per_minute = 0;
  const auto all = testing::make(options)->gnss_samples();
  options.gnss->outages_per_minute = 20;
  const auto some = testing::make(options)->gnss_samples();
  ASSERT_EQ(all.size(), some.size());
  std::size_t lost = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_TRUE(all[i].has_fix);
    lost += some[i].has_fix ? 0 : 1;
    ASSERT_TRUE(!some[i].has_fix || some[i].latitude_deg == all[i].latitude_deg);
  }
  EXPECT_GT(lost, 10U);
}

}  // namespace
}  // namespace holdfast::simulation
