#include "holdfast/pipeline/accumulate.hpp"

#include <tsl/robin_set.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace holdfast::pipeline {
namespace {

constexpr double kCellM = 0.05;
constexpr TimeNs kLongestGap = kSecond / 2;

/// Cells that already hold a point.
class OccupiedCells {
 public:
  bool take(const Eigen::Vector3d& p) {
    constexpr double kOffset = 1 << 20;
    const Eigen::Vector3d c = (p / kCellM).array().floor();
    const auto key = static_cast<std::uint64_t>(c.x() + kOffset) << 42 ^
                     static_cast<std::uint64_t>(c.y() + kOffset) << 21 ^
                     static_cast<std::uint64_t>(c.z() + kOffset);
    return cells_.insert(key * 0x9e3779b97f4a7c15ULL).second;
  }

 private:
  tsl::robin_set<std::uint64_t> cells_;
};

std::optional<SE3> pose_at(const std::vector<StampedPose>& poses, TimeNs t) {
  const auto after = std::lower_bound(poses.begin(), poses.end(), t,
                                      [](const StampedPose& p, TimeNs at) { return p.t < at; });
  if (after == poses.end()) return std::nullopt;
  if (after->t == t) return after->T_map_body;
  if (after == poses.begin()) return std::nullopt;
  const StampedPose& before = *(after - 1);
  if (after->t - before.t > kLongestGap) return std::nullopt;
  const double u = static_cast<double>(t - before.t) / static_cast<double>(after->t - before.t);
  return interpolate(before.T_map_body, after->T_map_body, u);
}

/// Poses of the LiDAR at regular instants of a scan; none if one is unknown.
constexpr int kInstants = 101;
std::vector<SE3> lidar_poses(const Scan& scan, const std::vector<StampedPose>& poses,
                             const SE3& T_body_lidar) {
  std::vector<SE3> result;
  for (int k = 0; k < kInstants; ++k) {
    const TimeNs t = scan.stamp + (scan.end_time - scan.stamp) * k / (kInstants - 1);
    const auto pose = pose_at(poses, t);
    if (!pose) return {};
    result.push_back(*pose * T_body_lidar);
  }
  return result;
}

bool add_scan(const Scan& scan, const std::vector<SE3>& T_map_lidar,
              const preprocess::ScanSelectionConfig& selection, OccupiedCells& cells,
              io::PointCloud& cloud) {
  if (T_map_lidar.empty()) return false;
  const auto span = static_cast<double>(scan.end_time - scan.stamp);
  for (const ScanPoint& p : scan.points) {
    const Eigen::Vector3d q(p.x, p.y, p.z);
    if (q.norm() < selection.min_range_m || q.norm() > selection.max_range_m) continue;
    const double x = span > 0 ? p.time_offset_ns / span * (kInstants - 1) : 0.0;
    const auto k = std::min(static_cast<std::size_t>(std::max(x, 0.0)), T_map_lidar.size() - 2);
    const Eigen::Vector3d a = T_map_lidar[k] * q;
    const Eigen::Vector3d b = T_map_lidar[k + 1] * q;
    const Eigen::Vector3d in_map = a + (x - static_cast<double>(k)) * (b - a);
    if (cells.take(in_map)) cloud.points.push_back((in_map - cloud.origin).cast<float>());
  }
  return true;
}

}  // namespace

Result<Accumulated> accumulate(SensorSource& log, const std::vector<StampedPose>& poses,
                               const SE3& T_body_lidar,
                               const preprocess::ScanSelectionConfig& selection,
                               io::PointCloud& cloud, const std::function<void(double)>& progress) {
  Accumulated result;
  OccupiedCells cells;
  if (cloud.points.empty() && !poses.empty() &&
      poses.front().T_map_body.translation.norm() > 10e3) {
    cloud.origin = poses.front().T_map_body.translation.array().round();
  }
  for (const auto& p : cloud.points) cells.take(p.cast<double>() + cloud.origin);
  while (true) {
    auto event = log.next();
    if (!event) return event.error();
    if (!event->has_value()) return result;
    const auto* scan = std::get_if<Scan>(&**event);
    if (scan == nullptr) continue;
    const bool added =
        add_scan(*scan, lidar_poses(*scan, poses, T_body_lidar), selection, cells, cloud);
    ++(added ? result.scans : result.outside);
    if (progress) progress(log.progress());
  }
}

}  // namespace holdfast::pipeline
