#pragma once

#include <filesystem>
#include <memory>

#include "holdfast/core/result.hpp"
#include "holdfast/io/log_file.hpp"

namespace holdfast::io::logs {

/// Opens a KITTI raw drive (see open_log()): velodyne_points as scans, the OXTS unit's
/// accelerations and rates as IMU samples in the body frame. A sweep of the HDL-64E turns clockwise
/// seen from above from the rear to the rear, between the times of timestamps_start.txt and
/// timestamps_end.txt: the time of a point follows from its azimuth. Topics are not used.
Result<std::unique_ptr<LogReader>> open_kitti_log(const std::filesystem::path& path,
                                                  const LogOptions& options);

}  // namespace holdfast::io::logs
