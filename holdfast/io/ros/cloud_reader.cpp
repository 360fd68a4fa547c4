#include "holdfast/io/ros/cloud_reader.hpp"

#include <fmt/format.h>

namespace holdfast::io::ros {
namespace {

constexpr std::size_t kTimeSamples = 5;
constexpr int kMostSurveyed = 100;

/// Replaces big-endian data by `swapped`, which it fills.
void make_little_endian(const CloudLayout& layout, CloudMessage& message, std::string& swapped) {
  if (!message.big_endian) return;
  swapped = swap_fields(message, layout);
  message.data = swapped;
}

}  // namespace

Result<CloudLayout> CloudReader::layout_of(const CloudMessage& message) {
  if (!known_layout_ || known_fields_ != message.fields || known_step_ != message.point_step) {
    auto layout = find_layout(message);
    if (!layout) return layout;
    known_layout_ = std::move(*layout);
    known_fields_ = message.fields;
    known_step_ = message.point_step;
  }
  return *known_layout_;
}

bool CloudReader::survey(std::string_view bytes, std::int64_t number) {
  auto message = parse_cloud(bytes);
  if (!message || message->points() == 0) return true;
  if (++surveyed_ > kMostSurveyed) return false;
  const auto layout = layout_of(*message);
  if (!layout) {
    if (!layout_error_) {
      layout_error_ = Error{fmt::format("scan {}: {}", number, layout.error().message)};
    }
    return true;
  }
  if (!has_layout_) time_field_ = layout->time;
  has_layout_ = true;
  if (!time_field_) return false;
  std::string swapped;
  make_little_endian(*layout, *message, swapped);
  auto sample = sample_times(*message, *layout);
  if (sample) {
    sample->number = number;
    samples_.push_back(*sample);
  }
  return samples_.size() < kTimeSamples;
}

Status CloudReader::settle() {
  if (!has_layout_ && layout_error_) return *layout_error_;
  if (samples_.empty()) return Done{};
  const auto rule = find_time_rule(time_field_, samples_);
  if (!rule) return rule.error();
  rule_ = *rule;
  return Done{};
}

std::optional<DecodedScan> CloudReader::decode(std::string_view bytes) {
  auto message = parse_cloud(bytes);
  if (!message) return std::nullopt;
  if (message->points() == 0) return decode_cloud(*message, {}, {});
  const auto layout = layout_of(*message);
  if (!layout || layout->time.name != time_field_.name || layout->time.type != time_field_.type) {
    return std::nullopt;
  }
  std::string swapped;
  make_little_endian(*layout, *message, swapped);
  return decode_cloud(*message, *layout, rule_);
}

}  // namespace holdfast::io::ros
