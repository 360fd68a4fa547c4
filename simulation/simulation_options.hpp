#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "simulation/events/event.hpp"
#include "simulation/scenario.hpp"
#include "simulation/sensors/gnss/gnss_receiver.hpp"
#include "simulation/sensors/imu/imu_model.hpp"
#include "simulation/sensors/lidar/lidar_model.hpp"
#include "simulation/sensors/lidar/returns/air.hpp"
#include "simulation/sensors/wheel/wheel_odometer.hpp"
#include "simulation/stated_extrinsics.hpp"
#include "simulation/transport/transport_model.hpp"

namespace holdfast::simulation {

/// Who moves the LiDAR.
enum class Motion {
  kWheels,      ///< the scenario's robot
  kHandheld,    ///< a walking person, see DriveStyle::in_hand()
  kTurnOnSpot,  ///< the scenario's robot, which turns on the spot at sharp corners
};

struct SimulationOptions {
  std::string scenario = "corridor";
  std::uint64_t seed = 1;            ///< another drive, other noise, in the same world
  std::optional<double> duration_s;  ///< length of the log; none: the scenario's whole route
  std::vector<EventSpec> events;
  ImuModel imu;
  LidarModel lidar = LidarModel::rs16();
  Weather weather;  ///< that the LiDAR looks through
  TransportModel transport;
  std::optional<WheelModel> wheel;   ///< none: the robot has no odometer
  std::optional<GnssModel> gnss;     ///< none: no receiver
  ExtrinsicsError extrinsics_error;  ///< of the T_body_lidar that config.yaml states
  Motion motion = Motion::kWheels;
  double speed_factor = 1;     ///< on the scenario's speed, turning rate and accelerations
  double wobble_rad = 0;       ///< amplitude of roll, pitch and yaw at 1 to 3 Hz; 0: the style's
  double map_sigma_m = 0.005;  ///< noise of the survey on each axis
  double changed_share = 0;    ///< of the world's objects since the survey, 0 to 1
  int threads = 1;             ///< the stream has the same bits for any number
};

/// The scenario's style of driving as the options change it.
DriveStyle style_of(const Scenario& scenario, const SimulationOptions& options);

/// What is wrong with a drive through `scenario` with these options, empty when nothing is.
std::string complaint(const Scenario& scenario, const SimulationOptions& options);

}  // namespace holdfast::simulation
