#include "holdfast/io/ros/point_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace holdfast::io::ros {
namespace {

constexpr double kUsualPeriodS = 0.1;
constexpr double kShortestPeriodS = 1e-3;
constexpr double kLongestPeriodS = 2.0;
constexpr double kMostPeriods = 3.0;

struct Unit {
  std::string_view name;
  double ns;
};
constexpr Unit kUnits[] = {{"s", 1e9}, {"ms", 1e6}, {"us", 1e3}, {"ns", 1.0}};

double scan_period(const std::vector<TimeSample>& samples) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double scans = static_cast<double>(samples[i].number - samples[i - 1].number);
    const double period = to_seconds(samples[i].stamp - samples[i - 1].stamp) / scans;
    if (period >= kShortestPeriodS && period <= kLongestPeriodS) periods.push_back(period);
  }
  if (periods.empty()) return kUsualPeriodS;
  const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
  std::nth_element(periods.begin(), middle, periods.end());
  return *middle;
}

const Unit& nearest_unit(double span, double period_s, bool is_integer) {
  const auto distance = [&](const Unit& unit) {
    return std::abs(std::log(span * unit.ns * 1e-9 / period_s));
  };
  // Whole seconds cannot tell the points of a scan apart.
  return *std::min_element(kUnits + (is_integer ? 1 : 0), std::end(kUnits),
                           [&](const Unit& a, const Unit& b) { return distance(a) < distance(b); });
}

/// How far from `reference` the earliest times lie, over all samples.
struct Offsets {
  bool near = true;   ///< within kMostTimeOffsetNs
  double spread = 0;  ///< largest difference between scans
};

template <class Reference>
Offsets offsets_from(const std::vector<TimeSample>& samples, double ns,
                     const Reference& reference) {
  Offsets offsets;
  double least = HUGE_VAL;
  double most = -HUGE_VAL;
  for (const auto& sample : samples) {
    const double low = sample.min * ns - reference(sample);
    const double high = sample.max * ns - reference(sample);
    offsets.near =
        offsets.near && std::abs(low) <= kMostTimeOffsetNs && std::abs(high) <= kMostTimeOffsetNs;
    least = std::min(least, low);
    most = std::max(most, low);
  }
  offsets.spread = most - least;
  return offsets;
}

TimeReference find_reference(const std::vector<TimeSample>& samples, double ns) {
  const auto zero = offsets_from(samples, ns, [](const TimeSample&) { return 0.0; });
  const auto stamp = offsets_from(
      samples, ns, [](const TimeSample& sample) { return static_cast<double>(sample.stamp); });
  if (zero.near && (!stamp.near || zero.spread <= stamp.spread)) return TimeReference::kStamp;
  return stamp.near ? TimeReference::kEpoch : TimeReference::kOwnClock;
}

}  // namespace

std::optional<TimeSample> sample_times(const CloudMessage& message, const CloudLayout& layout) {
  if (!layout.time) return std::nullopt;
  std::optional<TimeSample> sample;
  for (std::uint64_t i = 0; i < message.points(); ++i) {
    const char* point = message.data.data() + (i / message.width) * message.row_step +
                        (i % message.width) * message.point_step;
    const auto value = [point](const FieldPlace& field) {
      return files::load_as_double(field.type, point + field.offset);
    };
    const double size =
        std::abs(value(layout.x)) + std::abs(value(layout.y)) + std::abs(value(layout.z));
    const double t = value(layout.time);
    if (!(std::isfinite(size) && size > 0 && std::isfinite(t))) continue;
    if (!sample) sample = TimeSample{message.stamp, 0, t, t};
    sample->min = std::min(sample->min, t);
    sample->max = std::max(sample->max, t);
  }
  return sample;
}

Result<TimeRule> find_time_rule(const FieldPlace& field, const std::vector<TimeSample>& samples) {
  double span = 0;
  for (const auto& sample : samples) span = std::max(span, sample.max - sample.min);
  if (span == 0) return TimeRule{};
  const double period_s = scan_period(samples);
  const Unit& unit = nearest_unit(span, period_s, !files::is_floating(field.type));
  if (span * unit.ns * 1e-9 > std::min(kMostPeriods * period_s, kMostTimeOffsetNs * 1e-9)) {
    return Error{
        fmt::format("the times of the points (field '{}', {}) span {:.9g} within a scan; "
                    "in no unit (s, ms, us, ns) is this the duration of a scan, about "
                    "{:.3g} s",
                    field.name, files::name_of(field.type), span, period_s)};
  }
  return TimeRule{find_reference(samples, unit.ns), unit.name, unit.ns};
}

}  // namespace holdfast::io::ros
