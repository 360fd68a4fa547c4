#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/io/ros/point_cloud2.hpp"
#include "holdfast/io/ros/point_decoder.hpp"
#include "holdfast/io/ros/point_times.hpp"

namespace holdfast::io::ros {

/// Turns the clouds of one topic into scans. First the log's first messages are surveyed to learn
/// what the times of its points mean, then all are decoded by that one rule.
class CloudReader {
 public:
  /// Learns from a serialised message, scan `number` of the log. False when enough has been seen.
  bool survey(std::string_view bytes, std::int64_t number);
  /// Ends the survey. Error if the points lack x, y or z, or a field is of a type that it cannot
  /// have, in all surveyed messages, or if no unit explains the times.
  Status settle();

  /// The scan; empty for a message that does not hold together, or whose fields are not those of
  /// the survey.
  std::optional<DecodedScan> decode(std::string_view bytes);

  const std::string& time_field() const { return time_field_.name; }
  const TimeRule& time_rule() const { return rule_; }

 private:
  Result<CloudLayout> layout_of(const CloudMessage& message);

  std::string known_fields_;  ///< of the message that known_layout_ belongs to
  std::uint32_t known_step_ = 0;
  std::optional<CloudLayout> known_layout_;

  std::vector<TimeSample> samples_;
  std::optional<Error> layout_error_;
  int surveyed_ = 0;  ///< messages with points
  bool has_layout_ = false;
  FieldPlace time_field_;
  TimeRule rule_;
};

}  // namespace holdfast::io::ros
