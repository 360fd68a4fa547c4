#include "benchmarks/scores/deskew_errors.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace holdfast::benchmarks {
namespace {

using Eigen::Vector3d;
using preprocess::ScanMotion;

struct Mean {
  double sum = 0;
  std::size_t count = 0;

  void add(double value) {
    sum += std::abs(value);
    ++count;
  }
  double value() const {
    return count > 0 ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
  }
};

/// Places points of one scan in the map frame.
class Placer {
 public:
  Placer(const Scan& scan, const simulation::Simulation& drive, const preprocess::ImuSegment& imu,
         const preprocess::EndState& estimated)
      : drive_(drive), T_body_lidar_(drive.options().lidar.T_body_lidar), stamp_(scan.stamp) {
    T_map_end_ = drive.truth_at(scan.end_time);
    deskewed_.set(imu, estimated, T_body_lidar_, scan.stamp, scan.end_time);
    true_state_.set(imu, true_end_state(drive, scan.end_time), T_body_lidar_, scan.stamp,
                    scan.end_time);
  }

  /// T_map_lidar at the point's own time.
  SE3 T_map_lidar_at(const ScanPoint& p) const {
    return drive_.truth_at(stamp_ + p.time_offset_ns) * T_body_lidar_;
  }

  Vector3d place(Placement placement, const ScanPoint& p, const SE3& T_map_lidar) const {
    const Vector3d p_lidar(p.x, p.y, p.z);
    switch (placement) {
      case Placement::kRaw: return T_map_end_ * (T_body_lidar_ * p_lidar);
      case Placement::kDeskewed: return T_map_end_ * deskewed_.deskew(p).cast<double>();
      case Placement::kTrueState: return T_map_end_ * true_state_.deskew(p).cast<double>();
      case Placement::kTruePoses: break;
    }
    return T_map_lidar * p_lidar;
  }

 private:
  const simulation::Simulation& drive_;
  SE3 T_body_lidar_;
  SE3 T_map_end_;
  TimeNs stamp_;
  ScanMotion deskewed_;
  ScanMotion true_state_;
};

/// The point that a LiDAR without range noise would have measured.
ScanPoint without_noise(const ScanPoint& p, const Vector3d& hit_map, const SE3& T_map_lidar) {
  const double true_range = (hit_map - T_map_lidar.translation).norm();
  const auto scale = static_cast<float>(true_range / Vector3d(p.x, p.y, p.z).norm());
  ScanPoint exact = p;
  exact.x *= scale;
  exact.y *= scale;
  exact.z *= scale;
  return exact;
}

}  // namespace

preprocess::EndState true_end_state(const simulation::Simulation& drive, TimeNs t) {
  const simulation::TrueState truth = drive.state_at(t);
  const Eigen::Quaterniond R_body_map = truth.T_map_body.rotation.conjugate();
  return {R_body_map * truth.v_map, R_body_map * drive.options().imu.gravity_map, truth.gyro_bias,
          truth.accel_bias};
}

PlacementErrors placement_errors(const Scan& scan, simulation::Simulation& drive,
                                 const preprocess::ImuSegment& imu,
                                 const preprocess::EndState& estimated) {
  const auto truth = drive.true_geometry(scan);
  const Placer placer(scan, drive, imu, estimated);
  std::array<Mean, kPlacements> surface;
  std::array<Mean, kPlacements> exact_surface;
  std::array<Mean, kPlacements> edge;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const simulation::TrueReturn& hit = truth[i];
    if (hit.moving || !hit.is_surface()) continue;
    const ScanPoint& p = scan.points[i];
    const SE3 T_map_lidar = placer.T_map_lidar_at(p);
    const Vector3d across = hit.normal_map.cross(hit.edge_along_map);
    const bool clear = hit.edge_distance_m >= kClearOfEdgesM;
    const bool at_edge = hit.edge_distance_m < kAtEdgeM && across.norm() > 0.5;
    if (!clear && !at_edge) continue;
    const ScanPoint exact = without_noise(p, hit.point_map, T_map_lidar);
    for (std::size_t k = 0; k < kPlacements; ++k) {
      const auto placement = static_cast<Placement>(k);
      const Vector3d off = placer.place(placement, p, T_map_lidar) - hit.point_map;
      if (at_edge) edge[k].add(across.normalized().dot(off));
      if (!clear) continue;
      surface[k].add(hit.normal_map.dot(off));
      exact_surface[k].add(
          hit.normal_map.dot(placer.place(placement, exact, T_map_lidar) - hit.point_map));
    }
  }
  PlacementErrors errors;
  for (std::size_t k = 0; k < kPlacements; ++k) {
    errors[k] = {surface[k].value(), exact_surface[k].value(), edge[k].value()};
  }
  return errors;
}

}  // namespace holdfast::benchmarks
