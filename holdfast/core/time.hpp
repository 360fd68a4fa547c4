#pragma once

#include <cstdint>
#include <string>

namespace holdfast {

/// Absolute time or a duration in nanoseconds. Absolute times count from the epoch of the log.
using TimeNs = std::int64_t;

constexpr TimeNs kSecond = 1'000'000'000;

/// Seconds of `t`; exact to about 0.2 us for today's absolute times, so only for durations and
/// display.
constexpr double to_seconds(TimeNs t) { return static_cast<double>(t) * 1e-9; }

/// Nearest nanosecond to `seconds`.
constexpr TimeNs from_seconds(double seconds) {
  return static_cast<TimeNs>(seconds * 1e9 + (seconds < 0 ? -0.5 : 0.5));
}

/// Decimal seconds with 9 digits after the point ("1317042504.599424000"), without rounding.
std::string format_seconds(TimeNs t);

/// Parses decimal seconds exactly to the nanosecond; further digits are dropped.
/// Returns false (and leaves `t` alone) for text that is not a plain or scientific decimal number.
bool parse_seconds(const std::string& text, TimeNs& t);

}  // namespace holdfast
