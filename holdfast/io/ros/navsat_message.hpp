#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "holdfast/core/sensor_data.hpp"

namespace holdfast::io::ros {

/// A sensor_msgs/NavSatFix in frame "gnss": with a fix of its own augmentation (GBAS) and a known
/// diagonal covariance, or without a fix, with positions that are not numbers.
std::string serialise_navsat(const GnssSample& sample, std::uint32_t sequence);

/// Reads one back; empty if its size is wrong.
std::optional<GnssSample> parse_navsat(std::string_view message);

}  // namespace holdfast::io::ros
