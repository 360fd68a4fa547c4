#pragma once

#include <filesystem>
#include <memory>

#include "holdfast/core/result.hpp"
#include "holdfast/io/log_file.hpp"

namespace holdfast::io::logs {

/// Opens a ROS 1 bag (see open_log()). The layout of the points and the unit of their times are
/// found here, from the first scans with points; a field of a type that it cannot have is an error.
Result<std::unique_ptr<LogReader>> open_bag_log(const std::filesystem::path& path,
                                                const LogOptions& options);

}  // namespace holdfast::io::logs
