#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "holdfast/core/sensor_data.hpp"

namespace holdfast::io::ros {

/// A nav_msgs/Odometry from frame "wheel_odom" to "body". Only the variances of speed and yaw rate
/// are known: those of what a plane robot does not measure (and of the pose, which drifts) are 1e6.
std::string serialise_odometry(const WheelSample& sample, std::uint32_t sequence);

/// Reads one back; empty if its size is wrong. Of the covariances only those two are read.
std::optional<WheelSample> parse_odometry(std::string_view message);

}  // namespace holdfast::io::ros
