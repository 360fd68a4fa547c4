#include "holdfast/odometry/edges/edge_points.hpp"

namespace holdfast::odometry {
namespace {

constexpr std::size_t kManyPoints = 32000;

/// One of so many rings is enough.
std::uint16_t ring_step(const Scan& scan) {
  if (!scan.has_ring) return 1;
  return static_cast<std::uint16_t>(1 + (scan.points.size() - 1) / kManyPoints);
}

}  // namespace

EdgeFinder::EdgeFinder(double range_sigma_m)
    : extractor_(features::FeatureConfig{}, range_sigma_m) {}

void EdgeFinder::find(const Scan& scan, double min_range_m, double max_range_m,
                      std::vector<SeenEdge>& out) {
  const auto low = static_cast<float>(min_range_m), high = static_cast<float>(max_range_m);
  points_.clear();
  rings_.clear();
  source_.clear();
  const std::uint16_t step = ring_step(scan);
  for (std::uint32_t i = 0; i < scan.points.size(); ++i) {
    const ScanPoint& p = scan.points[i];
    if (p.ring % step != 0) continue;
    const Eigen::Vector3f q(p.x, p.y, p.z);
    const float range = q.norm();
    if (range < low || range > high) continue;
    points_.push_back(q);
    if (scan.has_ring) rings_.push_back(p.ring / step);  // neighbours again
    source_.push_back(i);
  }
  extractor_.extract(points_, rings_, features_);
  out.clear();
  for (const features::Feature& edge : features_.edges) {
    if (edge.axis.isZero()) continue;  // one ring alone has seen it
    ScanPoint p = scan.points[source_[edge.index]];
    p.x = edge.position.x();
    p.y = edge.position.y();
    p.z = edge.position.z();
    out.push_back({p, edge.axis, edge.sigma_m});
  }
}

std::vector<EdgePoint> put_edges(const std::vector<SeenEdge>& edges,
                                 const filter::SelectedScan& scan, const filter::MatchState& x) {
  const Eigen::Quaterniond R_body_map = x.T_map_body.rotation.conjugate();
  preprocess::ScanMotion motion;
  motion.set(scan.imu,
             {R_body_map * x.v_map, R_body_map * x.gravity_map, x.gyro_bias, x.accel_bias},
             scan.T_body_lidar, scan.scan->stamp, scan.scan->end_time);
  const Eigen::Matrix3f R_map_body = x.T_map_body.rotation.toRotationMatrix().cast<float>();
  std::vector<EdgePoint> put;
  put.reserve(edges.size());
  for (const SeenEdge& edge : edges) {
    ScanPoint end = edge.point;
    end.x += edge.axis.x();
    end.y += edge.axis.y();
    end.z += edge.axis.z();
    const Eigen::Vector3f position = R_map_body * motion.deskew(edge.point);
    const Eigen::Vector3f direction = R_map_body * motion.deskew(end) - position;
    put.push_back({position, direction.normalized(), edge.sigma_m});
  }
  return put;
}

}  // namespace holdfast::odometry
