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
Status write_log(Simulation& simulation, const std::filesystem::path& folder,
                 const Progress& progress);

/// config.yaml of the simulated robot: T_body_lidar and the noise of its sensors, and the initial
/// pose as a comment `# initial_pose: x y z qx qy qz qw`; above it the scenario's remark, if any.
std::string robot_config(Simulation& simulation);

/// "x y z qx qy qz qw" with 6 decimals for metres and 9 for the quaternion.
std::string pose_text(const SE3& pose);

}  // namespace holdfast::simulation
