#include "apps/log_run.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace holdfast::apps {
namespace {

/// What reading the log survived, for summary.json.
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

/// What of it a user should know, as sentences.
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

}  // namespace

LogRun::LogRun(std::string log, const RunOptions& options, std::string title)
    : log_(std::move(log)), options_(options), bar_(std::move(title)) {
  const auto log_options = value_or_fail(options.log_options(), 2);
  reader_ = value_or_fail(io::open_log(log_, log_options));
}

void LogRun::add(const StepReport& report, double progress) {
  summary_.add(report);
  bar_.update(progress, fmt::format("{} scans, {}, {:.2f} ms a scan", summary_.scans(),
                                    to_string(report.state), report.times.total_ms));
}

void LogRun::require_scans() const {
  if (summary_.scans() > 0) return;
  throw CommandFailed{1,
                      fmt::format("{}: no scan in this log{}", log_,
                                  options_.scans.empty() ? "" : " with --scans " + options_.scans)};
}

pipeline::RunSummary::About LogRun::about(const std::string& method) const {
  pipeline::RunSummary::About about;
  about.method = method;
  about.log = std::filesystem::path(log_).filename().string();
  about.threads = options_.threads;
  about.elapsed_s = elapsed_s_;
  about.counters = counters_of(*reader_);
  about.warnings = warnings_of(*reader_);
  return about;
}

}  // namespace holdfast::apps
