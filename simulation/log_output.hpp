#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "holdfast/core/result.hpp"
#include "simulation/simulation.hpp"

namespace holdfast::simulation {

/// Called with the share done, 0 to 1, and what is being done ("scans", "map").
using Progress = std::function<void(double, std::string_view)>;

/// Runs the simulation to its end and writes DIR/{run.bag, truth.tum, events.jsonl, map.pcd,
/// config.yaml}: all of them or nothing. DIR may exist only if it is empty or an older simulation.
/// Truth, events, the times at which messages were recorded and all stamps but those of /points are
/// in the IMU's clock; the stamps of /points are in the LiDAR's.
Status write_log(Simulation& simulation, const std::filesystem::path& folder,
                 const Progress& progress);

/// config.yaml of the simulated robot: T_body_lidar as it is stated and the noise of its sensors,
/// and as comments the initial pose (`# initial_pose: x y z qx qy qz qw`), the scenario's remark
/// and, where options ask for them, the true T_body_lidar, the LiDAR's clock, and where GNSS is
/// measured.
std::string robot_config(Simulation& simulation);

/// "x y z qx qy qz qw" with 6 decimals for metres and 9 for the quaternion.
std::string pose_text(const SE3& pose);

}  // namespace holdfast::simulation
