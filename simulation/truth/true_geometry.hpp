#pragma once

#include <vector>

#include "holdfast/core/sensor_data.hpp"
#include "simulation/motion/drive.hpp"
#include "simulation/movers/movers.hpp"
#include "simulation/sensors/lidar/lidar_model.hpp"
#include "simulation/sensors/lidar/return_kind.hpp"
#include "simulation/truth/segment_grid.hpp"
#include "simulation/world/ray_caster.hpp"
#include "simulation/world/walkers.hpp"

namespace holdfast::simulation {

/// The surface behind a LiDAR return.
struct TrueReturn {
  Eigen::Vector3d point_map;   ///< where the ray met the surface, without noise
  Eigen::Vector3d normal_map;  ///< of the surface, unit length, towards the LiDAR
  /// From point_map to the nearest true edge; at most TrueGeometry::kReach, which also stands for
  /// "further away".
  double edge_distance_m = 0;
  Eigen::Vector3d edge_along_map =
      Eigen::Vector3d::Zero();  ///< unit; zero without an edge in reach
  bool moving = false;          ///< met someone or something that moves: no edges are looked for
  /// Only kSurface has a true surface. Of other returns point_map is where the measured range puts
  /// them, the normal is zero, and no edges are looked for.
  ReturnKind kind = ReturnKind::kSurface;

  bool is_surface() const { return kind == ReturnKind::kSurface; }
};

/// What a world's surfaces are like, for judging features: edges as `true_edges` defines them
/// (discs have none). Thread-safe once made, which takes up to some seconds.
class TrueGeometry {
 public:
  /// Edges further away than this, in metres, are not looked for.
  static constexpr double kReach = SegmentGrid::kReach;

  /// `world` is used later and must outlive this.
  explicit TrueGeometry(const World& world);

  const std::vector<Segment>& edges() const { return edges_; }

  struct NearEdge {
    double distance_m = kReach;
    Eigen::Vector3d along = Eigen::Vector3d::Zero();  ///< unit; zero without an edge in reach
  };
  NearEdge nearest_edge(const Eigen::Vector3d& p_map) const;

  const World& world() const { return world_; }

 private:
  const World& world_;
  std::vector<Segment> edges_;
  SegmentGrid grid_;
};

/// What moves in a world besides the robot.
struct MovingThings {
  const Walkers& walkers;
  const Movers& movers;
};

/// Casts the ray of each return of `scan` again, from where the LiDAR was at the return's own time,
/// and says what it met: one entry a point, in the order of the points. Times of the scan count
/// from the start of the log. `kinds` says of each point where it comes from.
std::vector<TrueReturn> true_returns(const Scan& scan, const std::vector<ReturnKind>& kinds,
                                     const LidarModel& lidar, const Drive& drive,
                                     const RayCaster& caster, const MovingThings& moving,
                                     const TrueGeometry& geometry);

}  // namespace holdfast::simulation
