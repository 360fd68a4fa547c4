#pragma once

#include <cstdint>
#include <string>

#include "holdfast/core/sensor_data.hpp"
#include "holdfast/io/ros/point_cloud2.hpp"
#include "holdfast/io/ros/point_times.hpp"

namespace holdfast::io::ros {

/// What decoding found.
struct DecodedScan {
  Scan scan;                     ///< end_time of an empty scan is its stamp
  std::uint32_t no_returns = 0;  ///< points at (0, 0, 0), which drivers write for "nothing seen"
};

/// The points of a message as a scan. Non-finite points and points whose time is further than 1.05
/// s from its reference are dropped and counted as invalid, points at the origin as no_returns.
/// stamp is header.stamp, or the time of the first point where that is earlier; offsets are >= 0;
/// without times end_time is stamp. `layout` must come from this message's fields.
DecodedScan decode_cloud(const CloudMessage& message, const CloudLayout& layout,
                         const TimeRule& rule);

/// The message's data in little endian, for a message that is big endian: the used fields are
/// swapped.
std::string swap_fields(const CloudMessage& message, const CloudLayout& layout);

}  // namespace holdfast::io::ros
