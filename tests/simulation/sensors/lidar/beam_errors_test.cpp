#include "simulation/sensors/lidar/beam_errors.hpp"

#include <gtest/gtest.h>

#include "tests/simulation/sensors/lidar/still_lidar.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;
using testing::make;
using testing::position;
using testing::record;
using testing::room_with_wall;
using testing::still_at;
using testing::still_options;

constexpr std::uint16_t kFanBeams = 1024;
const Vector3d kPlace(5, 4, 1.5);

/// A fan of many beams, nearly level, that rests in a closed room.
SimulationOptions fan() {
  SimulationOptions options = still_options(0.5);
  options.lidar.beams.clear();
  for (std::uint16_t ring = 0; ring < kFanBeams; ++ring) {
    options.lidar.beams.push_back({1e-4 * (ring - 512), 0, ring});
  }
  options.lidar.columns = 16;
  return options;
}

std::vector<Scan> scans_of(const SimulationOptions& options) {
  return record(*make(still_at(kPlace, room_with_wall(materials::kIdeal)), options)).scans;
}

double mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(values.size());
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum / static_cast<double>(a.size()) / std::sqrt(mean_square(a) * mean_square(b));
}

TEST(BeamErrors, AreNoneUnlessAskedFor) {
  const LidarModel model = with_beam_errors(LidarModel::rs16(), 7);
  EXPECT_TRUE(TrueDirections(model).as_stated());
  for (const LidarBeam& beam : model.beams) EXPECT_EQ(beam.error.range_m, 0);
}

// All returns of a beam from walls at known ranges are off alike, in all scans.
TEST(BeamErrors, ABeamsRangesAreOffByItsOffsetOfTheConfiguredSize) {
  SimulationOptions options = fan();
  const auto exact = scans_of(options);
  options.lidar.faults.beam_offset_sigma_m = 0.02;
  const auto off = scans_of(options);
  std::vector<double> offsets(kFanBeams, NAN);
  ASSERT_EQ(off.size(), exact.size());
  ASSERT_GE(exact.size(), 2U);
  for (std::size_t s = 0; s < exact.size(); ++s) {
    ASSERT_EQ(off[s].points.size(), exact[s].points.size());
    for (std::size_t i = 0; i < exact[s].points.size(); ++i) {
      const ScanPoint& p = off[s].points[i];
      const double error = position(p).norm() - position(exact[s].points[i]).norm();
      double& offset = offsets.at(p.ring);
      if (std::isnan(offset)) offset = error;
      ASSERT_NEAR(error, offset, 2 * tolerances::kRayInRoom);
    }
  }
  EXPECT_NEAR(mean_square(offsets) / (0.02 * 0.02), 1, tolerances::variance_error(kFanBeams));
}

// A beam that is stated to hit the wall at x = 12 squarely but is off by (elevation, azimuth)
// = (e, a) measures the range of that direction, and the point lies on the stated ray.
TEST(BeamErrors, ATurnedBeamMeasuresElsewhereAndIsPlacedWhereItShouldPoint) {
  SimulationOptions options = fan();
  options.lidar.beams = {{0.1, 0, 0}};
  options.lidar.beams[0].error = {0, 0.03, -0.02};
  auto simulation = make(still_at(kPlace, room_with_wall(materials::kIdeal)), options);
  auto turned = options;
  turned.lidar.beams[0] = {0.1, 0, 0};
  const auto exact = scans_of(turned);
  const auto off = record(*simulation).scans;
  ASSERT_FALSE(off.empty());
  const SE3 pose = simulation->truth_at(off[0].stamp);
  for (std::size_t i = 0; i < off[0].points.size(); ++i) {
    const Vector3d stated = position(off[0].points[i]).normalized();
    EXPECT_LT((stated - position(exact[0].points[i]).normalized()).norm(), 1e-6);
    const double azimuth = std::atan2(stated.y(), stated.x()) - 0.02;
    const Vector3d ray(std::cos(0.13) * std::cos(azimuth), std::cos(0.13) * std::sin(azimuth),
                       std::sin(0.13));
    const double range = testing::room_range(pose.translation, pose.rotation * ray);
    EXPECT_NEAR(position(off[0].points[i]).norm(), range, tolerances::kRayInRoom);
  }
}

TEST(BeamErrors, AnglesHaveTheConfiguredSizeAndAreIndependent) {
  LidarModel model = fan().lidar;
  model.faults.beam_angle_sigma_deg = 0.1;
  const LidarModel drawn = with_beam_errors(model, 3);
  std::vector<double> up, around;
  for (const LidarBeam& beam : drawn.beams) {
    up.push_back(beam.error.elevation_rad);
    around.push_back(beam.error.azimuth_rad);
    EXPECT_EQ(beam.error.range_m, 0);
  }
  const double variance = std::pow(0.1 * std::numbers::pi / 180, 2);
  EXPECT_NEAR(mean_square(up) / variance, 1, tolerances::variance_error(kFanBeams));
  EXPECT_NEAR(mean_square(around) / variance, 1, tolerances::variance_error(kFanBeams));
  // 5 standard deviations of the correlation of independent values.
  EXPECT_LT(std::abs(correlation(up, around)), 5 / std::sqrt(kFanBeams));
  EXPECT_NE(with_beam_errors(model, 4).beams[0].error.elevation_rad, up[0]) << "another device";
}

// The truth is that of the ray as it was: the walls of the room, whatever the points say.
TEST(BeamErrors, TheTruthLiesWhereTheBeamWent) {
  SimulationOptions options = fan();
  options.lidar.faults.beam_angle_sigma_deg = 1;
  auto simulation = make(still_at(kPlace, room_with_wall(materials::kIdeal)), options);
  for (const auto& known : testing::known_returns(*simulation)) {
    // Ranges have no other errors: the true point is as far away as the measured one.
    const double true_range = (known.truth.point_map - known.from_map).norm();
    ASSERT_NEAR(true_range, known.range, 2 * tolerances::kRayInRoom);
  }
}

// Offsets have streams of their own: all other faults and all returns are those they would be.
TEST(BeamErrors, ChangeNoOtherStream) {
  SimulationOptions options;
  options.scenario = "office";
  options.duration_s = 0.5;
  options.lidar.faults = LidarFaults::usual();
  options.lidar.faults.beam_offset_sigma_m = options.lidar.faults.beam_angle_sigma_deg = 0;
  const auto before = record(*make(*make_scenario("office"), options)).scans;
  options.lidar.faults.beam_offset_sigma_m = 0.01;
  auto simulation = make(*make_scenario("office"), options);
  const LidarModel lidar = simulation->options().lidar;
  const auto after = record(*simulation).scans;
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t s = 0; s < after.size(); ++s) {
    ASSERT_EQ(after[s].points.size(), before[s].points.size());
    for (std::size_t i = 0; i < after[s].points.size(); ++i) {
      const ScanPoint& p = after[s].points[i];
      const auto beam = std::find_if(lidar.beams.begin(), lidar.beams.end(),
                                     [&](const LidarBeam& b) { return b.ring == p.ring; });
      const double off = position(p).norm() - position(before[s].points[i]).norm();
      ASSERT_NEAR(off, beam->error.range_m, tolerances::kRayInRoom);
      ASSERT_EQ(p.intensity, before[s].points[i].intensity);
    }
  }
}

}  // namespace
}  // namespace holdfast::simulation
