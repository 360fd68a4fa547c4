#include "simulation/sensors/lidar/returns/air.hpp"

#include <gtest/gtest.h>

#include "tests/simulation/sensors/lidar/still_lidar.hpp"

namespace holdfast::simulation {
namespace {

using testing::known_returns;
using testing::KnownReturn;
using testing::make;
using testing::room_range;
using testing::room_with_wall;
using testing::still_at;
using testing::still_options;

TEST(Air, WeakensLightAsItsSourcesSay) {
  EXPECT_TRUE(Air({}).is_clear());
  EXPECT_EQ(Air({}).echoes(0, 100), 0);
  // 1.076 * 20^0.67 = 8.01 dB on a kilometre; at the range of visibility 5 % are left.
  EXPECT_NEAR(std::exp(-1000 * Air({20, 0}).extinction()), std::pow(10, -0.801), 1e-3);
  EXPECT_NEAR(std::exp(-50 * Air({0, 50}).extinction()), 0.05, tolerances::kRounding);
  const double both = Air({20, 0}).extinction() + Air({0, 50}).extinction();
  EXPECT_NEAR(Air({20, 50}).extinction(), both, tolerances::kRounding);
}

TEST(Air, TheFirstEchoIsThatOfAPoissonProcess) {
  const Air air({20, 40});
  const double from = 0.4;
  for (const double depth : {0.01, 0.1, 0.2}) {
    const double r = air.first_echo(from, 50, depth);
    EXPECT_NEAR(air.echoes(from, r), depth, tolerances::kRounding);
    EXPECT_FALSE(std::isfinite(air.first_echo(from, r - 1e-6, depth)));
  }
}

// Each beam meets an echo before the wall with probability 1 - exp(-echoes up to the wall).
TEST(Air, RainIsSeenAsDenselyAsStated) {
  SimulationOptions options = still_options(1.5);
  options.weather = {60, 100};
  options.lidar.reach_at_10_percent_m = 10000;
  const auto simulation = make(still_at({5, 4, 1.5}, room_with_wall(materials::kIdeal)), options);
  const Air air(options.weather);
  double expected = 0;
  double variance = 0;
  double expected_near = 0;  // before 2 m
  double drops = 0;
  double near = 0;
  for (const KnownReturn& r : known_returns(*simulation)) {
    const double wall = room_range(r.from_map, r.ray_map);
    const double chance = 1 - std::exp(-air.echoes(options.lidar.min_range_m, wall));
    expected += chance;
    variance += chance * (1 - chance);
    expected_near += 1 - std::exp(-air.echoes(options.lidar.min_range_m, std::min(2.0, wall)));
    if (r.truth.kind == ReturnKind::kSurface) continue;
    ASSERT_EQ(r.truth.kind, ReturnKind::kAir);
    ASSERT_LT(r.range, wall);
    ASSERT_GT(r.range, options.lidar.min_range_m - 1e-6);
    ++drops;
    near += r.range < 2 ? 1 : 0;
  }
  EXPECT_GT(drops, 5000);
  EXPECT_NEAR(drops, expected, tolerances::count_error(variance));
  EXPECT_NEAR(near, expected_near, tolerances::count_error(expected_near));
}

TEST(Air, TakesFarReturnsAway) {
  SimulationOptions options = still_options(1);
  const auto count = [&](const Weather& weather) {
    options.weather = weather;
    const auto simulation =
        make(still_at({5, 4, 1.5}, room_with_wall(materials::kAsphalt)), options);
    double walls = 0;
    for (const KnownReturn& r : known_returns(*simulation)) {
      walls += r.truth.kind == ReturnKind::kSurface && r.range > 5 ? 1 : 0;
    }
    return walls;
  };
  EXPECT_GT(count({}), 1.1 * count({0, 10}));
}

TEST(Air, BadWeatherIsRefused) {
  EXPECT_TRUE(complaint(Weather{}).empty());
  EXPECT_TRUE(complaint(Weather{20, 50}).empty());
  EXPECT_NE(complaint(Weather{-1, 0}).find("expected 0 to 200"), std::string::npos);
  EXPECT_NE(complaint(Weather{0, 1}).find("expected 5 to"), std::string::npos);
  SimulationOptions options;
  options.weather.rain_mm_h = NAN;
  EXPECT_FALSE(Simulation::create(options));
}

}  // namespace
}  // namespace holdfast::simulation
