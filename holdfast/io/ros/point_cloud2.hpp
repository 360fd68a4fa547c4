#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "holdfast/core/result.hpp"
#include "holdfast/core/sensor_data.hpp"
#include "holdfast/io/files/scalar_type.hpp"

namespace holdfast::io::ros {

/// A serialised sensor_msgs/PointCloud2; views into the message.
struct CloudMessage {
  TimeNs stamp = 0;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string_view fields;  ///< the serialised array of PointField
  bool big_endian = false;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  std::string_view data;  ///< holds height rows of width points

  std::uint64_t points() const { return std::uint64_t{height} * width; }
};

/// Empty for a message whose parts do not hold together: it ends early, or its data is shorter than
/// height, width and steps demand.
std::optional<CloudMessage> parse_cloud(std::string_view message);

/// The header's stamp alone.
std::optional<TimeNs> parse_stamp(std::string_view message);

/// Where a used field stands in a point.
struct FieldPlace {
  std::string name;  ///< empty: the points do not have it
  std::uint32_t offset = 0;
  files::ScalarType type = files::ScalarType::kFloat32;

  explicit operator bool() const { return !name.empty(); }
};

/// The fields of a point that are used.
struct CloudLayout {
  FieldPlace x, y, z;
  FieldPlace intensity;
  FieldPlace ring;  ///< "ring", "channel" or "line"
  FieldPlace time;  ///< "time", "t", "timestamp", "time_offset" or "offset_time"
};

/// Finds the used fields. Error for fields that are missing or of a type they cannot have: x, y, z
/// are float32 or float64, ring is an integer, time any number (64-bit integers as two uint32 or
/// eight uint8), and each lies within a point.
Result<CloudLayout> find_layout(const CloudMessage& message);

/// A scan as a PointCloud2 with x y z intensity (float32), ring (uint16, if it has rings) and time
/// (float32 seconds from header.stamp, if it has times).
std::string serialise_cloud(const Scan& scan, std::uint32_t sequence, std::string_view frame);

}  // namespace holdfast::io::ros
