#pragma once

#include <filesystem>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/core/se3.hpp"

/// What a KITTI raw drive holds beside its log (open_log()). `path` is the drive's folder, or a
/// parent that holds exactly one.
namespace holdfast::io {

/// Poses of the body (the OXTS unit) at the OXTS times, from latitude and longitude by the Mercator
/// projection scaled at the first pose, altitude, roll, pitch and yaw: x east, y north, z up, and
/// the first pose at the origin. Samples whose time does not advance are left out.
Result<std::vector<StampedPose>> read_kitti_truth(const std::filesystem::path& path);

/// T_body_lidar, the inverse of calib_imu_to_velo.txt in the folder above the drive.
Result<SE3> read_kitti_extrinsics(const std::filesystem::path& path);

}  // namespace holdfast::io
