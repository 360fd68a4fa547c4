#include "simulation/sensors/lidar/lidar_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numbers>

#include "tests/simulation/support.hpp"

namespace holdfast::simulation {
namespace {

LidarModel lidar(const std::string& name) {
  auto model = make_lidar(name);
  EXPECT_TRUE(model) << model.error().message;
  return model ? std::move(*model) : LidarModel();
}

class NamedLidar : public ::testing::TestWithParam<std::string_view> {};

TEST_P(NamedLidar, NumbersItsRingsUpwardsAndFiresInTime) {
  const LidarModel model = lidar(std::string(GetParam()));
  std::vector<double> by_ring(model.beams.size(), NAN);
  for (const LidarBeam& beam : model.beams) by_ring.at(beam.ring) = beam.elevation_rad;
  EXPECT_TRUE(std::is_sorted(by_ring.begin(), by_ring.end()));
  EXPECT_TRUE(std::is_sorted(
      model.beams.begin(), model.beams.end(),
      [](const LidarBeam& a, const LidarBeam& b) { return a.fire_offset < b.fire_offset; }));
  EXPECT_LT(model.beams.back().fire_offset, model.period / model.columns);
}

TEST_P(NamedLidar, SeesTheWallsOfABox) {
  SimulationOptions options;
  options.scenario = "box";
  options.duration_s = 1;
  options.lidar = lidar(std::string(GetParam()));
  const auto simulation = Simulation::create(options);
  ASSERT_TRUE(simulation) << simulation.error().message;
  while (const auto event = *(*simulation)->next()) {
    if (!std::holds_alternative<Scan>(*event)) continue;
    const auto rays = options.lidar.beams.size() * static_cast<std::size_t>(options.lidar.columns);
    EXPECT_GT(std::get<Scan>(*event).points.size(), rays * 9 / 10);
  }
}

INSTANTIATE_TEST_SUITE_P(All, NamedLidar, ::testing::ValuesIn(lidar_names()),
                         [](const auto& named) { return std::string(named.param); });

/// Its manual: the lasers fire 2.304 us apart, the first at -15 degrees, the second at 1.
TEST(LidarFile, TheVlp16FiresInItsOwnOrder) {
  const LidarModel model = lidar("vlp16");
  ASSERT_EQ(model.beams.size(), 16U);
  EXPECT_NEAR(model.beams[1].elevation_rad, std::numbers::pi / 180, 1e-12);
  EXPECT_EQ(model.beams[1].ring, 8);
  EXPECT_EQ(model.beams[1].fire_offset, 2304);
}

struct LidarOnDisk : ::testing::Test {
  std::string path = ::testing::TempDir() + "lidar_file_test.yaml";

  Result<LidarModel> read(const std::string& text) {
    std::ofstream(path) << text;
    return make_lidar(path);
  }
  std::string complaint(const std::string& text) {
    const auto model = read(text);
    EXPECT_FALSE(model) << text;
    return model ? "" : model.error().message;
  }
};

TEST_F(LidarOnDisk, HasEvenBeamsOrItsOwn) {
  const auto even = read("beams: 3\nlowest_deg: -10\nhighest_deg: 10\ncolumns: 360\nrate_hz: 20");
  ASSERT_TRUE(even) << even.error().message;
  EXPECT_EQ(even->period, kSecond / 20);
  ASSERT_EQ(even->beams.size(), 3U);
  EXPECT_NEAR(even->beams[1].elevation_rad, 0, 1e-12);
  const auto own = read("elevations_deg: [5, -7]\nfire_step_us: 3");
  ASSERT_TRUE(own) << own.error().message;
  ASSERT_EQ(own->beams.size(), 2U);
  EXPECT_EQ(own->beams[0].ring, 1);
  EXPECT_EQ(own->beams[1].fire_offset, 3000);
}

TEST_F(LidarOnDisk, HasFaultsInABlockAndFactsThatTheyNeed) {
  const auto model = read(
      "divergence_mrad: 1.5\nreach_at_10_percent_m: 30\n"
      "faults: {dropout_share: 0.25, mixed_pixels: true, kept_return: last}");
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_NEAR(model->divergence_rad, 0.0015, 1e-12);
  EXPECT_EQ(model->reach_at_10_percent_m, 30);
  EXPECT_EQ(model->faults.dropout_share, 0.25);
  EXPECT_TRUE(model->faults.mixed_pixels);
  EXPECT_EQ(model->faults.kept_return, "last");
  EXPECT_EQ(model->faults.ghost_share, 0);
  EXPECT_NE(complaint("faults: {dropout_share: 2}").find("from 0 to 1"), std::string::npos);
  EXPECT_NE(complaint("faults: {kept_return: first}").find("strongest|last"), std::string::npos);
}

TEST_F(LidarOnDisk, MayBeARosette) {
  const auto model = read("pattern: rosette\nbeams: 2\nlowest_deg: -10\nhighest_deg: 30");
  ASSERT_TRUE(model) << model.error().message;
  ASSERT_TRUE(model->rosette);
  EXPECT_NEAR(model->rosette->half_band_rad, 10 * std::numbers::pi / 180, 1e-12);
  EXPECT_NEAR(model->beams[1].elevation_rad, 20 * std::numbers::pi / 180, 1e-12);
  EXPECT_NE(complaint("pattern: flower").find("spinning|rosette"), std::string::npos);
  EXPECT_NE(complaint("pattern: rosette\nturn_hz: 11").find("at most rate_hz"), std::string::npos);
  EXPECT_NE(complaint("pattern: rosette\nelevations_deg: [1]").find("from lowest_deg"),
            std::string::npos);
}

TEST_F(LidarOnDisk, ErrorsSayWhatIsExpected) {
  EXPECT_NE(complaint("beam: 3").find("nearest known key is 'beams'"), std::string::npos);
  EXPECT_NE(complaint("fire_step_us: 9").find("less than the 55.6 us of a column"),
            std::string::npos);
  EXPECT_NE(complaint("max_range_m: 0.2").find("max_range_m"), std::string::npos);
  EXPECT_NE(complaint("rate_hz: fast").find("lidar_file_test.yaml:1"), std::string::npos);
  const auto unknown = make_lidar("vlp61");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("vlp16"), std::string::npos);
}

}  // namespace
}  // namespace holdfast::simulation
