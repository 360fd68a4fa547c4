#include "simulation/truth/true_geometry.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/sensors/lidar/beam_errors.hpp"
#include "simulation/truth/true_edges.hpp"

namespace holdfast::simulation {

using Eigen::Vector3d;

TrueGeometry::TrueGeometry(const World& world)
    : world_(world), edges_(true_edges(world)), grid_(edges_) {}

TrueGeometry::NearEdge TrueGeometry::nearest_edge(const Vector3d& p_map) const {
  NearEdge nearest;
  grid_.near(p_map, [&](const SegmentGrid::Piece& piece) {
    const double there = distance(p_map, piece.segment);
    if (there >= nearest.distance_m) return;
    nearest = {there, (piece.segment.b - piece.segment.a).normalized()};
  });
  return nearest;
}

namespace {

/// The ray of a return, in the map frame.
struct Ray {
  Vector3d origin;
  Vector3d direction;
};

/// People as they stand at a time; they are looked up anew when it has gone on by more than a
/// column.
class PeopleAt {
 public:
  explicit PeopleAt(const Walkers& walkers) : walkers_(walkers) {}

  /// Shortens `range` to the nearest person before it, if any.
  bool meets(const Ray& ray, TimeNs t, double& range, Vector3d& normal) {
    if (walkers_.size() == 0) return false;
    constexpr TimeNs kColumn = 50'000;  // ns: at 2 m/s a tenth of a millimetre
    if (shapes_.empty() || std::abs(t - time_) > kColumn) {
      walkers_.shapes_at(t, shapes_);
      time_ = t;
    }
    bool met = false;
    for (const Capsule& shape : shapes_) {
      CapsuleHit hit{};
      if (!intersect(shape, ray.origin, ray.direction, 0, range, hit)) continue;
      met = true;
      range = hit.range;
      const Vector3d p = ray.origin + range * ray.direction;
      const Vector3d axis = shape.b - shape.a;
      const double along = std::clamp(axis.dot(p - shape.a) / axis.squaredNorm(), 0.0, 1.0);
      normal = (p - shape.a - along * axis).normalized();
    }
    return met;
  }

 private:
  const Walkers& walkers_;
  std::vector<Capsule> shapes_;
  TimeNs time_ = 0;
};

/// Shortens `range` to the nearest mover before it, if any.
bool meets_mover(const Movers& movers, const Ray& ray, TimeNs t, double& range, Vector3d& normal) {
  bool met = false;
  for (std::size_t i = 0; i < movers.size(); ++i) {
    const MotionState state = movers.at(i, t);
    const Vector3d way = state.T_map_body.translation - ray.origin;
    const double aside = way.cross(ray.direction).norm();
    MoverHit hit;
    if (aside > movers.radius(i)) continue;
    if (!movers.meets(i, state, 0, ray.origin, ray.direction, 0, range, hit)) continue;
    met = true;
    range = hit.range;
    normal = hit.normal_map;
  }
  return met;
}

/// The rays of up to eight points from `first` on; those that are missing repeat the last.
RayPacket packet_of(const std::vector<Ray>& rays, std::size_t first) {
  RayPacket packet;
  for (std::size_t lane = 0; lane < RayPacket::kSize; ++lane) {
    const Ray& ray = rays[std::min(first + lane, rays.size() - 1)];
    packet.x[lane] = static_cast<float>(ray.origin.x());
    packet.y[lane] = static_cast<float>(ray.origin.y());
    packet.z[lane] = static_cast<float>(ray.origin.z());
    packet.dx[lane] = static_cast<float>(ray.direction.x());
    packet.dy[lane] = static_cast<float>(ray.direction.y());
    packet.dz[lane] = static_cast<float>(ray.direction.z());
  }
  return packet;
}

std::vector<Ray> rays_of(const Scan& scan, const LidarModel& lidar, const Drive& drive) {
  std::vector<Ray> rays;
  const TrueDirections truly(lidar);
  for (const ScanPoint& point : scan.points) {
    const SE3 T_map_lidar =
        drive.at(scan.stamp + point.time_offset_ns).T_map_body * lidar.T_body_lidar;
    const Vector3d stated = Vector3d(point.x, point.y, point.z).normalized();
    const Vector3d direction = truly.of(stated, point.ring);
    rays.push_back({T_map_lidar.translation, T_map_lidar.rotation * direction});
  }
  return rays;
}

TrueReturn no_surface(ReturnKind kind, const Ray& ray, const ScanPoint& point) {
  TrueReturn truth;
  truth.point_map = ray.origin + Vector3d(point.x, point.y, point.z).norm() * ray.direction;
  truth.normal_map.setZero();
  truth.edge_distance_m = TrueGeometry::kReach;
  truth.kind = kind;
  return truth;
}

}  // namespace

std::vector<TrueReturn> true_returns(const Scan& scan, const std::vector<ReturnKind>& kinds,
                                     const LidarModel& lidar, const Drive& drive,
                                     const RayCaster& caster, const MovingThings& moving,
                                     const TrueGeometry& geometry) {
  const std::vector<Ray> rays = rays_of(scan, lidar, drive);
  std::vector<TrueReturn> out(rays.size());
  PeopleAt people(moving.walkers);
  HitPacket hits;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::size_t lane = i % RayPacket::kSize;
    if (lane == 0) {
      caster.cast(packet_of(rays, i), static_cast<float>(lidar.min_range_m),
                  static_cast<float>(lidar.max_range_m), hits);
    }
    const Ray& ray = rays[i];
    TrueReturn& truth = out[i];
    if (kinds[i] != ReturnKind::kSurface) {
      truth = no_surface(kinds[i], ray, scan.points[i]);
      continue;
    }
    double range = std::min<double>(hits.range[lane], lidar.max_range_m);
    const TimeNs t = scan.stamp + scan.points[i].time_offset_ns;
    truth.moving = people.meets(ray, t, range, truth.normal_map);
    truth.moving |= meets_mover(moving.movers, ray, t, range, truth.normal_map);
    truth.point_map = ray.origin + range * ray.direction;
    if (!truth.moving) {
      const Vector3d normal = normal_of(geometry.world(), hits.triangle[lane]);
      truth.normal_map = normal.dot(ray.direction) > 0 ? Vector3d(-normal) : normal;
    }
    const auto edge =
        truth.moving ? TrueGeometry::NearEdge() : geometry.nearest_edge(truth.point_map);
    truth.edge_distance_m = edge.distance_m;
    truth.edge_along_map = edge.along;
  }
  return out;
}

}  // namespace holdfast::simulation
