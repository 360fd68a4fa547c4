#include "simulation/sensors/lidar/scan_pattern.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "simulation/sensors/lidar/lidar_file.hpp"
#include "tests/simulation/sensors/lidar/still_lidar.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kDegree = std::numbers::pi / 180;

LidarModel lidar(const std::string& name) { return *make_lidar(name); }

double elevation_deg(const Vector3f& d) { return std::asin(static_cast<double>(d.z())) / kDegree; }

double azimuth_deg(const Vector3f& d) {
  const double turn = std::atan2(static_cast<double>(d.y()), static_cast<double>(d.x()));
  return std::fmod(turn / kDegree + 360, 360);
}

TEST(ScanPattern, OneThatSpinsIsTheSameInEachFrame) {
  const LidarModel model = LidarModel::rs16();
  EXPECT_EQ(ray_directions(model, 0), ray_directions(model, 7));
}

TEST(ScanPattern, TheMid360FiresItsRateOverItsField) {
  const LidarModel model = lidar("mid360");
  const double rate =
      static_cast<double>(model.beams.size()) * model.columns / to_seconds(model.period);
  EXPECT_EQ(rate, 200000);
  double lowest = 90, highest = -90;
  const auto directions = ray_directions(model, 3);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    ASSERT_NEAR(static_cast<double>(directions[i].norm()), 1, 1e-6);
    const double elevation = elevation_deg(directions[i]);
    lowest = std::min(lowest, elevation);
    highest = std::max(highest, elevation);
    // Each line keeps to its quarter of 59 degrees.
    const auto line = static_cast<double>(i % 4);
    ASSERT_GT(elevation, -7 + 14.75 * line - 1e-4);
    ASSERT_LT(elevation, -7 + 14.75 * (line + 1) + 1e-4);
  }
  EXPECT_NEAR(lowest, -7, 0.05);
  EXPECT_NEAR(highest, 52, 0.05);
}

/// Cells of a degree by a degree, in both angles, that rays fall into.
void mark_cells(const std::vector<Vector3f>& directions, std::set<std::pair<int, int>>& cells) {
  for (const Vector3f& d : directions) {
    cells.insert(
        {static_cast<int>(azimuth_deg(d)), static_cast<int>(std::floor(elevation_deg(d)))});
  }
}

TEST(ScanPattern, TheMid360NeverRepeatsAndFillsItsField) {
  const LidarModel model = lidar("mid360");
  constexpr double kCells = 360 * 59;
  std::set<std::pair<int, int>> cells;
  std::set<std::vector<float>> starts;
  double after_one = 0, after_ten = 0;
  for (std::size_t frame = 0; frame < 30; ++frame) {
    const auto directions = ray_directions(model, frame);
    mark_cells(directions, cells);
    if (frame == 0) after_one = static_cast<double>(cells.size());
    if (frame == 9) after_ten = static_cast<double>(cells.size());
    const Vector3f& d = directions[1000];
    EXPECT_TRUE(starts.insert({d.x(), d.y(), d.z()}).second) << frame;
  }
  EXPECT_LT(after_one, 0.75 * kCells) << "a frame leaves gaps";
  EXPECT_GT(after_ten, 0.97 * kCells);
  EXPECT_GT(static_cast<double>(cells.size()), 0.999 * kCells);
}

// All 100 000 frames of 2.8 hours start at another phase of turn and nod.
TEST(ScanPattern, TheMid360DoesNotRepeatForHours) {
  const RosettePattern rosette = *lidar("mid360").rosette;
  std::set<std::pair<long, long>> phases;
  for (long frame = 0; frame < 100000; ++frame) {
    // In units of 1e-5 of a turn and a nod, which a frame of 0.1 s moves on by whole numbers.
    const long turn = std::lround(rosette.turn_hz * 1e4) * frame % 100000;
    const long nod = std::lround(rosette.nod_hz * 1e4) * frame % 100000;
    phases.insert({turn, nod});
  }
  EXPECT_EQ(phases.size(), 100000U);
}

TEST(ScanPattern, TheMid360MeasuresTheRoomAndSaysWhen) {
  SimulationOptions options = testing::still_options(1);
  options.lidar = lidar("mid360");
  options.lidar.range_sigma_m = 0;
  options.lidar.keep_all_returns = true;
  const auto simulation = testing::make(
      testing::still_at({5, 4, 1.5}, testing::room_with_wall(materials::kIdeal)), options);
  const SE3 T_map_lidar = simulation->initial_pose() * options.lidar.T_body_lidar;
  std::size_t frame = 0;
  for (const Scan& scan : testing::record(*simulation).scans) {
    ASSERT_EQ(scan.points.size(), 20000U);
    const auto directions = ray_directions(options.lidar, frame++);
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const ScanPoint& p = scan.points[i];
      ASSERT_EQ(p.time_offset_ns, static_cast<std::int32_t>(i / 4) * 20000);
      ASSERT_EQ(p.ring, i % 4);
      const Vector3d ray = T_map_lidar.rotation * directions[i].cast<double>();
      ASSERT_NEAR(testing::position(p).norm(), testing::room_range(T_map_lidar.translation, ray),
                  30 * tolerances::kRayInRoom);
    }
  }
  EXPECT_GE(frame, 8U);
}

TEST(ScanPattern, TheHeliosHasUnevenChannelsThatFireDownwards) {
  const LidarModel model = lidar("helios16");
  ASSERT_EQ(model.beams.size(), 16U);
  EXPECT_EQ(model.columns, 3600);
  for (std::size_t i = 0; i < 16; ++i) {
    const double nominal = 15 - 2.0 * static_cast<double>(i);
    EXPECT_NEAR(model.beams[i].elevation_rad / kDegree, nominal, 0.1);
    EXPECT_EQ(model.beams[i].ring, 15 - i);
    EXPECT_EQ(model.beams[i].fire_offset, static_cast<TimeNs>(i) * 1730);
  }
  EXPECT_NEAR(model.beams[0].elevation_rad / kDegree, 14.95, 1e-9) << "the manual's example";
  const double step = model.beams[0].elevation_rad - model.beams[1].elevation_rad;
  EXPECT_GT(std::abs(step / kDegree - 2), 0.05) << "channels are not even";
}

}  // namespace
}  // namespace holdfast::simulation
