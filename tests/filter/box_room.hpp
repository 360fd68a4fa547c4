#pragma once

#include <functional>
#include <memory>

#include "holdfast/core/random.hpp"
#include "holdfast/filter/scan_update.hpp"
#include "tests/map/built_map.hpp"
#include "tests/map/clouds.hpp"

/// A room that is a box, its map, and what a LiDAR of 16 beams sees in it in closed form.
namespace holdfast::filter::testing {

using Eigen::Vector3d;

inline const Vector3d kGravity(0, 0, -9.81);
constexpr TimeNs kStart = 1'700'000'000 * kSecond;
constexpr TimeNs kRevolution = kSecond / 10;
constexpr double kRangeSigma = 0.02;

/// Free space from `low` to `high`.
struct Box {
  Vector3d low;
  Vector3d high;

  /// How far a ray from inside reaches.
  double range(const Vector3d& from, const Vector3d& direction) const {
    double least = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0) continue;
      const double wall = direction[axis] > 0 ? high[axis] : low[axis];
      least = std::min(least, (wall - from[axis]) / direction[axis]);
    }
    return least;
  }

  /// Its six sides as surveyed.
  io::PointCloud survey(double spacing = map::testing::kSpacing) const {
    RandomStream random(1, "survey");
    io::PointCloud cloud;
    const Vector3d size = high - low;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d u = size[(axis + 1) % 3] * Vector3d::Unit((axis + 1) % 3);
      const Vector3d v = size[(axis + 2) % 3] * Vector3d::Unit((axis + 2) % 3);
      const Vector3d across = size[axis] * Vector3d::Unit(axis);
      map::testing::add_patch(low, u, v, random, cloud.points, spacing);
      map::testing::add_patch(low + across, u, v, random, cloud.points, spacing);
    }
    return cloud;
  }
};

/// A room of 8 x 6 x 3 m; small enough for every test to have its map.
inline Box small_room() { return {{-3.1, -2.2, -0.1}, {4.9, 3.8, 2.9}}; }

/// T_map_body as a function of the time before the end of the scan, s.
using Motion = std::function<SE3(double)>;

inline SE3 some_extrinsic() { return {so3::exp({0.01, -0.02, 0.3}), {0.1, -0.05, 0.15}}; }

/// One revolution of a LiDAR on a moving body: 16 beams, `columns` columns.
inline Scan look_around(const Box& box, const Motion& T_map_body, const SE3& T_body_lidar,
                        std::uint64_t seed, int columns = 450) {
  RandomStream random(seed, "ranges");
  Scan scan;
  scan.stamp = kStart;
  scan.end_time = kStart + kRevolution;
  scan.has_ring = scan.has_point_times = true;
  for (int column = 0; column < columns; ++column) {
    const TimeNs offset = kRevolution * column / (columns - 1);
    const SE3 T = T_map_body(to_seconds(kRevolution - offset)) * T_body_lidar;
    const double azimuth = -2 * M_PI * column / columns;
    for (int beam = 0; beam < 16; ++beam) {
      const double elevation = (2 * beam - 15) * M_PI / 180;
      const Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                         std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const double range =
          box.range(T.translation, T.rotation * ray) + random.normal(0, kRangeSigma);
      const Eigen::Vector3f p = (range * ray).cast<float>();
      scan.points.push_back({p.x(), p.y(), p.z(), 0, static_cast<std::int32_t>(offset),
                             static_cast<std::uint16_t>(beam)});
    }
  }
  return scan;
}

/// Readings each 5 ms over the scan of a body that does not turn or accelerate.
inline preprocess::ImuSegment steady_imu(const Eigen::Quaterniond& R_map_body) {
  preprocess::ImuSegment segment;
  for (int i = 0; i <= 20; ++i) {
    segment.samples.push_back(
        {kStart + kRevolution * i / 20, Vector3d::Zero(), R_map_body.conjugate() * -kGravity});
  }
  return segment;
}

/// Everything that a scan update works on.
struct Scene {
  Scan scan;
  SelectedScan selected;
  SE3 truth;  ///< T_map_body at the end of the scan
  Vector3d v_map = Vector3d::Zero();
};

/// A body that moves straight on at `v_map` and is at `truth` when the scan ends.
inline std::unique_ptr<Scene> scene(const Box& box, const SE3& truth, const Vector3d& v_map,
                                    std::uint64_t seed = 1) {
  auto s = std::make_unique<Scene>();
  s->truth = truth;
  s->v_map = v_map;
  const auto motion = [&](double age) {
    return SE3{truth.rotation, truth.translation - age * v_map};
  };
  s->scan = look_around(box, motion, some_extrinsic(), seed);
  s->selected.scan = &s->scan;
  for (std::uint32_t i = 0; i < s->scan.points.size(); ++i) s->selected.selected.push_back(i);
  s->selected.imu = steady_imu(truth.rotation);
  s->selected.T_body_lidar = some_extrinsic();
  return s;
}

inline map::PriorMap focused(const map::testing::BuiltMap& built) {
  map::PriorMap map = built.open();
  const auto status = map.focus(Vector3d::Zero(), 150.0);
  EXPECT_TRUE(status) << status.error().message;
  return map;
}

inline double position_error(const FilterState& state, const SE3& truth) {
  return (state.T_map_body.translation - truth.translation).norm();
}

inline double angle_error(const FilterState& state, const SE3& truth) {
  return so3::angle_between(state.T_map_body.rotation, truth.rotation);
}

}  // namespace holdfast::filter::testing
