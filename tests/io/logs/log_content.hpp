#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "holdfast/io/log_file.hpp"

namespace holdfast::io::testing {

/// All that a log yields.
struct LogContent {
  std::vector<ImuSample> imu;
  std::vector<Scan> scans;
  std::string order;  ///< "i" and "s" in the order of the events
  LogCounters counters;
  PointTimeLayout times;
};

inline LogContent drain(LogReader& log) {
  LogContent content;
  while (true) {
    auto event = log.next();
    EXPECT_TRUE(event) << event.error().message;
    if (!event || !*event) break;
    if (auto* scan = std::get_if<Scan>(&**event)) {
      content.scans.push_back(std::move(*scan));
      content.order += 's';
    } else {
      content.imu.push_back(std::get<ImuSample>(**event));
      content.order += 'i';
    }
  }
  content.counters = log.counters();
  content.times = log.point_times();
  return content;
}

inline LogContent read_log(const std::filesystem::path& path, const LogOptions& options = {}) {
  auto log = open_log(path, options);
  EXPECT_TRUE(log) << log.error().message;
  return log ? drain(**log) : LogContent{};
}

inline std::string error_of_log(const std::filesystem::path& path, const LogOptions& options = {}) {
  const auto log = open_log(path, options);
  EXPECT_FALSE(log);
  return log ? "" : log.error().message;
}

}  // namespace holdfast::io::testing
