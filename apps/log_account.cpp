#include "apps/log_account.hpp"

#include <fmt/format.h>

namespace holdfast::apps {

std::vector<std::pair<std::string, std::uint64_t>> counters_of(const io::LogReader& reader) {
  const io::LogCounters& c = reader.counters();
  return {{"imu_samples", c.imu_samples},
          {"scans", c.scans},
          {"points", c.points},
          {"invalid_points", c.invalid_points},
          {"empty_scans", c.empty_scans},
          {"non_finite_imu", c.non_finite_imu},
          {"imu_stamps_back", c.imu_stamps_back},
          {"scan_stamps_back", c.scan_stamps_back},
          {"bad_messages", c.bad_messages},
          {"truncated", c.truncated ? 1U : 0U}};
}

std::vector<std::string> warnings_of(const io::LogReader& reader) {
  const io::LogCounters& c = reader.counters();
  std::vector<std::string> warnings;
  const auto warn = [&](std::uint64_t count, const char* what) {
    if (count > 0) warnings.push_back(fmt::format("{} {}", count, what));
  };
  warn(c.bad_messages, "messages do not hold together and were left out");
  warn(c.non_finite_imu, "IMU readings are not finite and were left out");
  warn(c.imu_stamps_back, "IMU readings are not later than the one before and were left out");
  warn(c.scan_stamps_back, "scans are not later than the one before and were left out");
  warn(c.empty_scans, "scans are empty");
  if (c.truncated) warnings.emplace_back("the log ends early; what came before was used");
  if (reader.point_times().field.empty()) {
    warnings.emplace_back("the points carry no times: motion during a scan is not corrected");
  }
  return warnings;
}

}  // namespace holdfast::apps
