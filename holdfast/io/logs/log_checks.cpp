#include "holdfast/io/logs/log_checks.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace holdfast::io::logs {
namespace {

constexpr std::size_t kPeriodsKept = 9;
constexpr TimeNs kUsualPeriod = kSecond / 10;

}  // namespace

Status check_slice(const LogOptions& options) {
  if (options.scan_start >= 0 && options.scan_step >= 1) return Done{};
  return Error{fmt::format("--scans {}:{}:{}: expected START >= 0 and STEP >= 1",
                           options.scan_start, options.scan_stop, options.scan_step)};
}

bool is_in_slice(const LogOptions& options, std::int64_t number) {
  return number >= options.scan_start && (options.scan_stop < 0 || number < options.scan_stop) &&
         (number - options.scan_start) % options.scan_step == 0;
}

bool ImuCheck::accept(const ImuSample& sample, LogCounters& counters) {
  if (!sample.gyro_rad_s.allFinite() || !sample.accel_m_s2.allFinite()) {
    ++counters.non_finite_imu;
    return false;
  }
  if (sample.t <= last_) {
    ++counters.imu_stamps_back;
    return false;
  }
  last_ = sample.t;
  ++counters.imu_samples;
  return true;
}

bool ScanCheck::accept(Scan& scan, std::int64_t number, std::uint32_t no_returns,
                       LogCounters& counters) {
  if (scan.stamp <= last_) {
    ++counters.scan_stamps_back;
    return false;
  }
  learn_period(scan.stamp, number);
  if (scan.points.empty()) {
    scan.end_time = scan.stamp + nominal_period();
    ++counters.empty_scans;
  }
  ++counters.scans;
  counters.points += scan.points.size();
  counters.invalid_points += scan.invalid_points;
  counters.no_return_points += no_returns;
  return true;
}

void ScanCheck::learn_period(TimeNs stamp, std::int64_t number) {
  if (last_ != std::numeric_limits<TimeNs>::min()) {
    if (periods_.size() == kPeriodsKept) periods_.erase(periods_.begin());
    periods_.push_back((stamp - last_) / std::max<std::int64_t>(number - last_number_, 1));
  }
  last_ = stamp;
  last_number_ = number;
}

TimeNs ScanCheck::nominal_period() const {
  if (periods_.empty()) return kUsualPeriod;
  auto sorted = periods_;
  std::sort(sorted.begin(), sorted.end());
  return sorted[sorted.size() / 2];
}

}  // namespace holdfast::io::logs
