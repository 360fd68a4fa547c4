#include "holdfast/io/logs/bag_log.hpp"

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/io/bag/bag_file.hpp"
#include "holdfast/io/files/errors.hpp"
#include "holdfast/io/logs/log_checks.hpp"
#include "holdfast/io/logs/topics.hpp"
#include "holdfast/io/ros/cloud_reader.hpp"
#include "holdfast/io/ros/imu_message.hpp"
#include "holdfast/io/ros/message_types.hpp"
#include "holdfast/io/ros/point_cloud2.hpp"

namespace holdfast::io::logs {
namespace {

using files::error_at;

constexpr TimeNs kLeap = 10 * kSecond;
constexpr TimeNs kNoStamp = std::numeric_limits<TimeNs>::min();

class BagLog : public LogReader {
 public:
  BagLog(bag::BagFile bag, LogOptions options)
      : bag_(std::move(bag)), options_(std::move(options)) {}

  Status prepare();

  Result<std::optional<SensorEvent>> next() override;
  double progress() const override;
  const LogCounters& counters() const override { return counters_; }
  PointTimeLayout point_times() const override;
  TimeNs duration() const override { return bag_.duration(); }

 private:
  Status list_messages();
  bool is_scan(const bag::MessagePlace& place) const { return is_points_[place.connection]; }
  std::optional<TimeNs> next_stamp(bool of_scans);
  bool is_lone_leap(TimeNs stamp, TimeNs last, bool of_scans);
  std::optional<ImuSample> read_imu(const bag::MessagePlace& place);
  std::optional<Scan> read_scan(const bag::MessagePlace& place, std::int64_t number);
  Status survey_clouds();

  bag::BagFile bag_;
  LogOptions options_;
  LogCounters counters_;
  std::vector<bool> is_points_;  ///< by connection
  std::vector<bag::MessagePlace> messages_;
  std::size_t at_ = 0;
  std::int64_t next_scan_number_ = 0;
  ImuCheck imu_check_;
  ScanCheck scan_check_;
  ros::CloudReader clouds_;
};

Status BagLog::prepare() {
  auto slice = check_slice(options_);
  if (!slice) return slice;
  counters_.truncated = bag_.truncated();
  if (bag_.truncated() && bag_.connections().empty()) {
    return error_at(bag_.path(), "ends early: it has no index and no readable message");
  }
  auto listed = list_messages();
  if (!listed) return listed;
  return survey_clouds();
}

Status BagLog::list_messages() {
  auto points = select_topic(
      bag_, {ros::kPointCloud2Type, ros::kPointCloud2Md5, "--points", options_.points_topic, true});
  if (!points) return points.error();
  const auto imu = select_topic(
      bag_, {ros::kImuType, ros::kImuMd5, "--imu", options_.imu_topic, options_.need_imu});
  if (!imu) return imu.error();
  is_points_ = std::move(*points);
  std::vector<bool> wanted = is_points_;
  for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = wanted[i] || (*imu)[i];
  messages_ = bag_.list_messages(wanted, counters_.bad_messages);
  return Done{};
}

double BagLog::progress() const {
  return messages_.empty() ? 1.0 : static_cast<double>(at_) / static_cast<double>(messages_.size());
}

PointTimeLayout BagLog::point_times() const {
  const auto& rule = clouds_.time_rule();
  if (rule.reference == ros::TimeReference::kNone) return {};
  return {clouds_.time_field(), std::string(rule.unit),
          rule.reference == ros::TimeReference::kEpoch,
          rule.reference == ros::TimeReference::kOwnClock};
}

Result<std::optional<SensorEvent>> BagLog::next() {
  while (at_ < messages_.size()) {
    const auto place = messages_[at_++];
    if (!is_scan(place)) {
      auto sample = read_imu(place);
      if (sample) return std::optional<SensorEvent>(std::move(*sample));
      continue;
    }
    const std::int64_t number = next_scan_number_++;
    if (!is_in_slice(options_, number)) continue;
    auto scan = read_scan(place, number);
    if (scan) return std::optional<SensorEvent>(std::move(*scan));
  }
  return std::optional<SensorEvent>();
}

/// Stamp of the message of this kind that follows the current one.
std::optional<TimeNs> BagLog::next_stamp(bool of_scans) {
  for (std::size_t i = at_; i < messages_.size(); ++i) {
    if (is_scan(messages_[i]) != of_scans) continue;
    const auto bytes = bag_.read(messages_[i]);
    const auto stamp = bytes ? ros::parse_stamp(*bytes) : std::nullopt;
    if (stamp) return stamp;
  }
  return std::nullopt;
}

/// A damaged stamp far in the future would make all that follow look old. It is told from a clock
/// that was set by the message after it.
bool BagLog::is_lone_leap(TimeNs stamp, TimeNs last, bool of_scans) {
  const bool is_first = last == kNoStamp;
  if (!is_first && stamp <= last + kLeap) return false;
  const auto next = next_stamp(of_scans);
  return next && *next < stamp - kLeap;
}

std::optional<ImuSample> BagLog::read_imu(const bag::MessagePlace& place) {
  const auto bytes = bag_.read(place);
  auto sample = bytes ? ros::parse_imu(*bytes) : std::nullopt;
  if (!sample) {
    ++counters_.bad_messages;
    return std::nullopt;
  }
  if (is_lone_leap(sample->t, imu_check_.last(), false)) {
    ++counters_.imu_stamps_ahead;
    return std::nullopt;
  }
  if (!imu_check_.accept(*sample, counters_)) return std::nullopt;
  return sample;
}

std::optional<Scan> BagLog::read_scan(const bag::MessagePlace& place, std::int64_t number) {
  const auto bytes = bag_.read(place);
  auto decoded = bytes ? clouds_.decode(*bytes) : std::nullopt;
  if (!decoded) {
    ++counters_.bad_messages;
    return std::nullopt;
  }
  if (is_lone_leap(decoded->scan.stamp, scan_check_.last(), true)) {
    ++counters_.scan_stamps_ahead;
    return std::nullopt;
  }
  if (!scan_check_.accept(decoded->scan, number, decoded->no_returns, counters_)) {
    return std::nullopt;
  }
  return std::move(decoded->scan);
}

Status BagLog::survey_clouds() {
  std::int64_t number = 0;
  for (const auto& place : messages_) {
    if (!is_scan(place) || !is_in_slice(options_, number++)) continue;
    const auto bytes = bag_.read(place);
    if (bytes && !clouds_.survey(*bytes, number - 1)) break;
  }
  const auto settled = clouds_.settle();
  if (!settled) return error_at(bag_.path(), "{}", settled.error().message);
  return Done{};
}

}  // namespace

Result<std::unique_ptr<LogReader>> open_bag_log(const std::filesystem::path& path,
                                                const LogOptions& options) {
  auto bag = bag::BagFile::open(path);
  if (!bag) return bag.error();
  auto log = std::make_unique<BagLog>(std::move(*bag), options);
  const auto ready = log->prepare();
  if (!ready) return ready.error();
  return std::unique_ptr<LogReader>(std::move(log));
}

}  // namespace holdfast::io::logs
