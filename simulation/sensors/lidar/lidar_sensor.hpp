#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "holdfast/core/parallel.hpp"
#include "holdfast/core/sensor_data.hpp"
#include "simulation/events/time_span.hpp"
#include "simulation/motion/drive.hpp"
#include "simulation/movers/movers.hpp"
#include "simulation/sensors/lidar/lidar_model.hpp"
#include "simulation/sensors/lidar/return_kind.hpp"
#include "simulation/sensors/lidar/returns/return_model.hpp"
#include "simulation/world/ray_caster.hpp"
#include "simulation/world/walkers.hpp"

namespace holdfast::simulation {

/// What a LiDAR looks at while the robot drives.
struct Surroundings {
  const RayCaster& caster;
  const std::vector<Material>& materials;
  const Drive& drive;
  const Walkers& walkers;
  const Movers& movers;
  std::vector<TimeSpan> blind;  ///< when the LiDAR sees nothing
};

/// Casts every ray from where the LiDAR is at the ray's own time.
class LidarSensor {
 public:
  LidarSensor(const LidarModel& model, std::uint64_t seed, const Weather& weather = {});

  /// A scan, and where each of its points comes from.
  struct Revolution {
    Scan scan;
    std::vector<ReturnKind> kinds;  ///< one a point; empty: all are surfaces
  };

  /// The revolution that begins at `begin` (from the start of the log); its index names its noise.
  /// Points are in the order of firing; Scan::stamp is that of the first return, from the start of
  /// the log. Same bits for any number of threads.
  Scan revolve(std::size_t index, TimeNs begin, const Surroundings& around, WorkerPool& pool) const;
  Revolution revolve_with_kinds(std::size_t index, TimeNs begin, const Surroundings& around,
                                WorkerPool& pool) const;

 private:
  /// The LiDAR at the start of a column, and how its rays move from there, in the map frame.
  struct ColumnPose {
    Eigen::Vector3f origin;
    Eigen::Vector3f velocity;
    Eigen::Matrix3f rotation;
    Eigen::Matrix3f rotation_rate;
  };
  struct Chunk;

  std::vector<Chunk> cast(std::size_t index, TimeNs begin, const Surroundings& around,
                          WorkerPool& pool) const;
  void prepare_chunk(Chunk& chunk, const Surroundings& around) const;
  void look_about(std::size_t frame);
  Eigen::Vector3d point_at(double range, std::size_t ray) const;
  ColumnPose column_pose(const Drive& drive, TimeNs t) const;
  TimeNs fire_time(std::size_t column, std::size_t beam) const;
  void cast_chunk(Chunk& chunk, const Surroundings& around) const;
  void cast_walkers(Chunk& chunk, const Surroundings& around) const;
  void cast_movers(Chunk& chunk, const Surroundings& around) const;
  void cast_mover(Chunk& chunk, const Movers& movers, std::size_t mover, TimeNs middle) const;
  bool may_see(const Chunk& chunk, const Eigen::Vector3d& center, double radius) const;
  void measure_chunk(Chunk& chunk, const Surroundings& around) const;

  // With faults or weather.
  void keep_echoes(std::vector<Chunk>& chunks) const;
  void measure_spoilt(Chunk& chunk, const Surroundings& around) const;

  LidarModel model_;
  std::uint64_t seed_;
  std::optional<ReturnModel> returns_;       ///< none: no faults, clear air
  std::vector<TimeNs> column_times_;         ///< from the start of the revolution
  std::vector<Eigen::Vector3f> directions_;  ///< in the lidar frame, [column][beam]
  std::vector<Eigen::Vector3f> stated_;      ///< those of its points; empty: the same
  std::size_t frame_ = 0;                    ///< of a rosette, whose directions they are
};

}  // namespace holdfast::simulation
