#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/core/sensor_data.hpp"
#include "holdfast/io/point_cloud.hpp"
#include "simulation/change/world_change.hpp"
#include "simulation/events/event.hpp"
#include "simulation/movers/movers.hpp"
#include "simulation/scenario.hpp"
#include "simulation/simulation_options.hpp"
#include "simulation/transport/lidar_clock.hpp"
#include "simulation/truth/true_geometry.hpp"

namespace holdfast::simulation {

/// The exact state behind the measurements.
struct TrueState {
  TimeNs t = 0;
  SE3 T_map_body;
  Eigen::Vector3d v_map = Eigen::Vector3d::Zero();       ///< m/s
  Eigen::Vector3d a_map = Eigen::Vector3d::Zero();       ///< m/s^2, without gravity
  Eigen::Vector3d omega_body = Eigen::Vector3d::Zero();  ///< rad/s
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();   ///< rad/s
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();  ///< m/s^2
};

/// A robot that drives through a world, as a stream of sensor events in order of end time (IMU
/// before scan at equal times), together with the truth. The IMU begins at start_time() and covers
/// the end of the last scan, unless an imu_off or the transport takes samples away. Same scenario,
/// options and seed: same bits, for any number of threads. Not thread-safe; uses its own worker
/// threads.
///
/// All times are those of the IMU's clock, which shows the true time, except those in a Scan, which
/// are the LiDAR's (options.transport.lidar_clock, clock_jump). Events come in order of the true
/// time at which they end, whatever a scan's stamps say.
class Simulation : public SensorSource {
 public:
  /// Errors: unknown scenario (with the list of known ones), an event outside the log, models that
  /// make no sense (no beams, a rate that does not divide a second).
  static Result<std::unique_ptr<Simulation>> create(const SimulationOptions& options);

  /// A world of one's own; options.scenario is ignored.
  static Result<std::unique_ptr<Simulation>> create(Scenario scenario,
                                                    const SimulationOptions& options);

  ~Simulation() override;

  /// Never an Error.
  Result<std::optional<SensorEvent>> next() override;
  /// True time at which what next() has handed out last was complete; start_time() before.
  TimeNs last_event_time() const;
  double progress() const override;

  TimeNs start_time() const;
  TimeNs end_time() const;         ///< time of the last IMU sample
  std::size_t scan_count() const;  ///< messages

  /// T_map_body at `t`, clamped to the log; at a teleport the pose after it.
  SE3 truth_at(TimeNs t) const;
  /// Likewise with derivatives and biases (those of the last IMU sample not after `t`).
  TrueState state_at(TimeNs t) const;
  /// T_map_body at the IMU's times; at a teleport two poses with one stamp, before and after.
  std::vector<StampedPose> truth() const;
  /// T_map_body at the first scan's pose time (its last point). Casts that scan if next() has not.
  SE3 initial_pose();

  /// What wheels and satellites tell over the whole log, in order of time; empty unless options ask
  /// for them. Does not depend on next().
  std::vector<WheelSample> wheel_samples() const;
  std::vector<GnssSample> gnss_samples() const;

  /// The LiDAR's clock as it was drawn; its times count from the start of the log.
  const LidarClock& lidar_clock() const;

  /// The surfaces behind the returns of a scan of this simulation, one entry a point (also of a
  /// scan from which points were taken away). Edges are those of the world as driven; the first
  /// call takes up to some seconds to find them.
  std::vector<TrueReturn> true_geometry(const Scan& scan);
  /// All true edges of the world as driven; likewise.
  const std::vector<Segment>& edges();

  const std::vector<SimulatedEvent>& events() const;
  const SimulationOptions& options() const;
  /// The scenario as driven: its world is the one after the changes.
  const Scenario& scenario() const;
  /// All who walk there, a crowd included; times from the start of the log.
  const Walkers& people() const;
  /// What else moves; likewise.
  const Movers& movers() const;
  /// The scan with the times at which its points were truly measured, whatever the LiDAR's clock
  /// said: truth_at() of them is where the robot was.
  Scan in_true_time(const Scan& scan) const;
  /// What has changed in the world since the survey.
  const std::vector<ObjectChange>& changes() const;

  /// The static world as a surveyor saw it, before anything changed: points about 6 cm apart with
  /// noise of map_sigma_m on each axis, on surfaces that the LiDAR can see from the route. Takes a
  /// moment (visibility is ray-cast).
  io::PointCloud survey_map();

 private:
  struct Parts;
  explicit Simulation(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace holdfast::simulation
