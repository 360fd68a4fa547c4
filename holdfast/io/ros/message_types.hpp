#pragma once

#include <string_view>

/// Names, checksums and definitions of the messages that are read and written, as ROS 1 knows them.
namespace holdfast::io::ros {

inline constexpr std::string_view kPointCloud2Type = "sensor_msgs/PointCloud2";
inline constexpr std::string_view kPointCloud2Md5 = "1158d486dd51d683ce2f1be655c3c181";
inline constexpr std::string_view kImuType = "sensor_msgs/Imu";
inline constexpr std::string_view kImuMd5 = "6a62c6daae103f4ff57a132d6f95cec2";

/// The message's definition and those of all messages in it, without comments.
extern const std::string_view kPointCloud2Definition;
extern const std::string_view kImuDefinition;

}  // namespace holdfast::io::ros
