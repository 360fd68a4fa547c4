#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "holdfast/core/sensor_data.hpp"
#include "holdfast/io/log_file.hpp"

/// What all readers of logs check alike.
namespace holdfast::io::logs {

/// Error for a slice that cannot be: START < 0 or STEP < 1.
Status check_slice(const LogOptions& options);
/// Whether the slice holds the scan of this number.
bool is_in_slice(const LogOptions& options, std::int64_t number);

/// Lets finite samples with growing stamps pass; counts all.
class ImuCheck {
 public:
  bool accept(const ImuSample& sample, LogCounters& counters);
  TimeNs last() const { return last_; }

 private:
  TimeNs last_ = std::numeric_limits<TimeNs>::min();
};

/// Lets scans with growing stamps pass, counts all, and gives empty ones an end.
class ScanCheck {
 public:
  /// `number`: place of the scan in the log, so that a slice has the same period. `no_returns`:
  /// points that were no returns.
  bool accept(Scan& scan, std::int64_t number, std::uint32_t no_returns, LogCounters& counters);
  TimeNs last() const { return last_; }

 private:
  void learn_period(TimeNs stamp, std::int64_t number);
  TimeNs nominal_period() const;

  TimeNs last_ = std::numeric_limits<TimeNs>::min();
  std::int64_t last_number_ = 0;
  std::vector<TimeNs> periods_;  ///< the last few, oldest first
};

}  // namespace holdfast::io::logs
