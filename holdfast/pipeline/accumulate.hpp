#pragma once

#include <functional>
#include <vector>

#include "holdfast/core/se3.hpp"
#include "holdfast/core/sensor_data.hpp"
#include "holdfast/io/point_cloud.hpp"
#include "holdfast/preprocess/scan_selection.hpp"

namespace holdfast::pipeline {

struct Accumulated {
  std::size_t scans = 0;    ///< added to the cloud
  std::size_t outside = 0;  ///< left out: not wholly inside the times of the poses
};

/// Adds the scans of a log to `cloud` in the map frame, each point at the pose of its own time
/// (between the neighbouring poses of `T_map_body`, ascending). Of points nearer than 5 cm to one
/// another (in one cell of that size) the first stays. Gaps of more than 0.5 s between poses are
/// not bridged.
Result<Accumulated> accumulate(SensorSource& log, const std::vector<StampedPose>& poses,
                               const SE3& T_body_lidar,
                               const preprocess::ScanSelectionConfig& selection,
                               io::PointCloud& cloud,
                               const std::function<void(double)>& progress = {});

}  // namespace holdfast::pipeline
