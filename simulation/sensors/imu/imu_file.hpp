#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "holdfast/core/result.hpp"
#include "simulation/sensors/imu/imu_model.hpp"

namespace holdfast::simulation {

/// The IMU of that name, or the one in a file whose name ends in .yaml; keys that the file does not
/// hold are those of the default IMU. The error lists the known names; those of files name file,
/// line, key, what was expected and found.
Result<ImuModel> make_imu(const std::string& name);

/// All that have a name; "article" is the default.
std::vector<std::string_view> imu_names();

/// The keys of such a file with defaults and ranges, in Markdown.
std::string imu_reference();

/// The text of a file in simulation/sensors/imu/imus ("n200.yaml"), which was built in.
std::string_view imu_text(std::string_view file);

}  // namespace holdfast::simulation
