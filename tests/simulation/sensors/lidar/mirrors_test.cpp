#include "simulation/sensors/lidar/returns/mirrors.hpp"

#include <gtest/gtest.h>

#include "tests/simulation/sensors/lidar/still_lidar.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;
using testing::known_returns;
using testing::KnownReturn;
using testing::make;
using testing::room_range;
using testing::room_with_wall;
using testing::still_at;
using testing::still_options;

/// Returns nothing itself and throws on four of five beams.
constexpr Material kMirror{"mirror", 0.9, 0.0, 0.0, 0.8, 1e-3};

TEST(Mirrors, ShowGhostsAtTheMirroredPlaceAsOftenAsConfigured) {
  SimulationOptions options = still_options(1);
  options.lidar.keep_all_returns = false;
  options.lidar.faults.ghost_share = 0.6;
  const auto simulation = make(still_at({7, 3, 1.5}, room_with_wall(kMirror)), options);
  double ghosts = 0;
  const auto returns = known_returns(*simulation);
  for (const KnownReturn& r : returns) {
    if (r.truth.kind == ReturnKind::kSurface) {
      ASSERT_LT(r.truth.point_map.x(), 12 - 1e-5) << "the mirror itself is not seen";
      continue;
    }
    ASSERT_EQ(r.truth.kind, ReturnKind::kGhost);
    EXPECT_TRUE(r.truth.normal_map.isZero());
    ++ghosts;
    // Seen in a mirror at x = 12, the ray goes on from the LiDAR's mirror image.
    const Vector3d p = r.from_map + r.range * r.ray_map;
    ASSERT_GT(p.x(), 12);
    const Vector3d behind(24 - p.x(), p.y(), p.z());
    double off = 1e9;
    const Vector3d size(12, 8, 4);
    for (int k = 0; k < 3; ++k) {
      off = std::min({off, std::abs(behind[k]), std::abs(behind[k] - size[k])});
    }
    ASSERT_LT(off, 3 * tolerances::kRayInRoom);
  }
  // 28800 rays a scan; those that meet the mirror are known from the LiDAR's place.
  const SE3 T_map_lidar = simulation->initial_pose();
  double at_mirror = 0;
  for (const LidarBeam& beam : options.lidar.beams) {
    for (int column = 0; column < 1800; ++column) {
      const double turned = (column / 1800.0) + static_cast<double>(beam.fire_offset) / 1e8;
      const double azimuth = -2 * std::numbers::pi * turned;
      const Vector3d ray =
          T_map_lidar.rotation * Vector3d(std::cos(beam.elevation_rad) * std::cos(azimuth),
                                          std::cos(beam.elevation_rad) * std::sin(azimuth),
                                          std::sin(beam.elevation_rad));
      const double r = room_range(T_map_lidar.translation, ray);
      at_mirror += (T_map_lidar.translation + r * ray).x() > 12 - 1e-9 ? 1 : 0;
    }
  }
  const double n = at_mirror * static_cast<double>(simulation->scan_count());
  const double share = 0.6 * 0.8;
  EXPECT_GT(n, 5000);
  EXPECT_NEAR(ghosts, share * n, tolerances::count_error(share * (1 - share) * n));
}

TEST(Mirrors, CornersReturnHalfOfTheWayByBothFaces) {
  SimulationOptions options = still_options(1);
  options.lidar.faults.multipath_share = 0.3;
  const auto simulation = make(still_at({7, 3, 1.5}, room_with_wall(materials::kIdeal)), options);
  double in_corner = 0;
  double longer = 0;
  for (const KnownReturn& r : known_returns(*simulation)) {
    const double first = room_range(r.from_map, r.ray_map);
    const Vector3d p = r.from_map + first * r.ray_map;
    Vector3d on = r.ray_map;
    const Vector3d size(12, 8, 4);
    for (int k = 0; k < 3; ++k) {
      if (std::abs(p[k]) < 1e-5 || std::abs(p[k] - size[k]) < 1e-5) on[k] = -on[k];
    }
    const double second = room_range(p + 1e-4 * on, on) + 1e-4;
    const bool near_corner = second < Mirrors::kCorner;
    in_corner += near_corner ? 1 : 0;
    if (r.truth.kind == ReturnKind::kSurface) {
      ASSERT_NEAR(r.range, first, 10 * tolerances::kRayInRoom);
      continue;
    }
    ++longer;
    ASSERT_EQ(r.truth.kind, ReturnKind::kMultipath);
    const double back = (p + second * on - r.from_map).norm();
    ASSERT_NEAR(r.range, 0.5 * (first + second + back), 30 * tolerances::kRayInRoom);
    ASSERT_GT(r.range, first);
  }
  EXPECT_GT(in_corner, 2000);
  EXPECT_NEAR(longer, 0.3 * in_corner, tolerances::count_error(0.3 * 0.7 * in_corner));
}

}  // namespace
}  // namespace holdfast::simulation
