#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "holdfast/map/map_info.hpp"
#include "holdfast/pipeline/config.hpp"
#include "simulation/simulation.hpp"

namespace holdfast::benchmarks {

struct DriveSpec {
  std::string scenario;
  std::uint64_t seed = 1;
  double duration_s = 20;
  int threads = 1;  ///< for casting rays and fitting surfaces; the drive does not depend on it
  std::vector<std::string> settings = {};  ///< module.key=value, over the robot's configuration
  simulation::LidarModel lidar = simulation::LidarModel::rs16();
  std::vector<simulation::EventSpec> events = {};
  double changed_share = 0;  ///< of the world's objects since the survey
  simulation::Motion motion = simulation::Motion::kWheels;
};

/// A simulated drive that has not begun, and all that `holdfast localize` would be given: the map
/// of its own survey and the configuration that `holdfast simulate` writes.
struct SurveyedDrive {
  std::unique_ptr<simulation::Simulation> simulation;
  pipeline::Config config;
  std::filesystem::path map_dir;
  SE3 initial_pose;  ///< T_map_body at the end of the first scan
};

/// Makes the drive with its map in `dir`, a folder that exists.
Result<SurveyedDrive> survey_drive(const DriveSpec& spec, const std::filesystem::path& dir);

/// The same without a map.
Result<std::unique_ptr<simulation::Simulation>> make_drive(const DriveSpec& spec);

/// The configuration that `holdfast simulate` writes, by way of a file in `dir`, with `settings`.
Result<pipeline::Config> load_robot_config(simulation::Simulation& drive,
                                           const std::vector<std::string>& settings,
                                           const std::filesystem::path& dir);

/// Runs the drive to its end, into a ROS 1 bag.
Status record_bag(simulation::Simulation& drive, const std::filesystem::path& bag);

}  // namespace holdfast::benchmarks
