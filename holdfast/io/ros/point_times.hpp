#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/io/ros/point_cloud2.hpp"

/// Drivers do not agree on what the time of a point is; its unit and reference are found from the
/// numbers themselves, once per log:
/// 1. The unit is that of s, ms, us, ns which brings the longest span of times within one scan
/// nearest
///    to the scan period (the median difference of the first stamps; 0.1 s as long as there is only
///    one). Units are 1000 apart, so this is unique; a span above three periods is an error.
/// 2. Times within 1.05 s of zero are relative to header.stamp, times within 1.05 s of header.stamp
/// are
///    absolute. Where both hold (a simulation that begins at 0), the one that varies less from scan
///    to scan is taken. Where neither holds, the sensor has its own clock: its first point is taken
///    to be measured at header.stamp.
/// 3. A field whose values are all equal is no time.
namespace holdfast::io::ros {

/// A point further than this from its reference has no usable time.
inline constexpr double kMostTimeOffsetNs = 1.05e9;

enum class TimeReference : std::uint8_t { kNone, kStamp, kEpoch, kOwnClock };

struct TimeRule {
  TimeReference reference = TimeReference::kNone;
  std::string_view unit;  ///< "s", "ms", "us" or "ns"
  double ns_per_unit = 0;
};

/// The raw times of one scan with points.
struct TimeSample {
  TimeNs stamp = 0;         ///< header.stamp
  std::int64_t number = 0;  ///< of the scan in the log
  double min = 0;           ///< in the field's unit
  double max = 0;
};

/// Smallest and largest time among the points that are returns; empty if there are none, or the
/// points have no times. min and max of the sample are set.
std::optional<TimeSample> sample_times(const CloudMessage& message, const CloudLayout& layout);

/// The rule that explains the samples (at least one).
Result<TimeRule> find_time_rule(const FieldPlace& field, const std::vector<TimeSample>& samples);

}  // namespace holdfast::io::ros
