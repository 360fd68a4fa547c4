#pragma once

#include <string>
#include <string_view>

/// Names, checksums and definitions of the messages that are read and written, as ROS 1 knows them.
namespace holdfast::io::ros {

inline constexpr std::string_view kPointCloud2Type = "sensor_msgs/PointCloud2";
inline constexpr std::string_view kPointCloud2Md5 = "1158d486dd51d683ce2f1be655c3c181";
inline constexpr std::string_view kImuType = "sensor_msgs/Imu";
inline constexpr std::string_view kImuMd5 = "6a62c6daae103f4ff57a132d6f95cec2";
inline constexpr std::string_view kOdometryType = "nav_msgs/Odometry";
inline constexpr std::string_view kOdometryMd5 = "cd5e73d190d741a2f92e81eda573aca7";
inline constexpr std::string_view kNavSatFixType = "sensor_msgs/NavSatFix";
inline constexpr std::string_view kNavSatFixMd5 = "2d3a8cd499b9b4a0249fb98fd05cfa48";

/// The message's definition and those of all messages in it, without comments.
std::string point_cloud2_definition();
std::string imu_definition();
std::string odometry_definition();
std::string nav_sat_fix_definition();

}  // namespace holdfast::io::ros
