#include "holdfast/pipeline/run_summary.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace holdfast::pipeline {
namespace {

/// The q-quantile (nearest rank) of a list.
double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  const auto rank =
      static_cast<std::size_t>(std::clamp(std::ceil(q * static_cast<double>(values.size())) - 1.0,
                                          0.0, static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank),
                   values.end());
  return values[rank];
}

nlohmann::ordered_json percentiles(const std::vector<double>& values) {
  return {{"p50", quantile(values, 0.5)},
          {"p95", quantile(values, 0.95)},
          {"p99", quantile(values, 0.99)},
          {"max", quantile(values, 1.0)}};
}

}  // namespace

void RunSummary::add(const StepReport& report) {
  if (cpu_ms_.empty()) first_ = report.stamp;
  last_ = report.pose_time;
  cpu_ms_.push_back(report.times.total_ms);
  wall_ms_.push_back(report.times.wall_ms);
  for (std::size_t i = 0; i < stage_ms_.size(); ++i) stage_ms_[i].push_back(report.times.ms[i]);
  ++by_state_[static_cast<std::size_t>(report.state)];
  claimed_ += claims_pose(report.state) ? 1 : 0;
  relocalizations_ += report.search && report.search->accepted ? 1 : 0;
  held_ += report.imu_held_ns > 0 ? 1 : 0;
}

double RunSummary::median_step_ms() const { return quantile(cpu_ms_, 0.5); }

std::string RunSummary::json(const About& about) const {
  nlohmann::ordered_json j;
  j["method"] = about.method;
  j["log"] = about.log;
  j["map"] = about.map;
  j["map_identity"] = about.map_identity;
  j["threads"] = about.threads;
  j["scans"] = scans();
  j["claimed"] = claimed_;
  j["duration_s"] = seconds();
  j["step_ms"] = percentiles(cpu_ms_);
  j["step_wall_ms"] = percentiles(wall_ms_);
  for (std::size_t i = 0; i < stage_ms_.size(); ++i) {
    j["stage_p50_ms"][std::string(kStageNames[i])] = quantile(stage_ms_[i], 0.5);
  }
  j["peak_rss_mb"] = peak_rss_mb();
  j["status_share"] = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < by_state_.size(); ++i) {
    if (by_state_[i] == 0) continue;
    j["status_share"][std::string(to_string(static_cast<State>(i)))] =
        static_cast<double>(by_state_[i]) / static_cast<double>(scans());
  }
  j["relocalizations"] = relocalizations_;
  j["realtime_factor"] = about.elapsed_s > 0 ? seconds() / about.elapsed_s : 0.0;
  j["counters"]["scans_with_imu_held"] = held_;
  for (const auto& [name, count] : about.counters) j["counters"][name] = count;
  j["warnings"] = about.warnings;
  return j.dump(2) + "\n";
}

double peak_rss_mb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace holdfast::pipeline
