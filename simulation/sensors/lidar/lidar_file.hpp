#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "holdfast/core/result.hpp"
#include "simulation/sensors/lidar/lidar_model.hpp"

namespace holdfast::simulation {

/// The LiDAR of that name, or the one in a file whose name ends in .yaml. The error lists the known
/// names; those of files name file, line, key, what was expected and found.
Result<LidarModel> make_lidar(const std::string& name);

/// All that have a name.
std::vector<std::string_view> lidar_names();

/// The keys of such a file with defaults and ranges, in Markdown.
std::string lidar_reference();

/// The text of a file in simulation/sensors/lidar/lidars ("vlp16.yaml"), which was built in.
std::string_view lidar_text(std::string_view file);

}  // namespace holdfast::simulation
