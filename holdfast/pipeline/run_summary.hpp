#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "holdfast/core/step_report.hpp"

namespace holdfast::pipeline {

/// What a run amounts to, gathered step by step.
class RunSummary {
 public:
  void add(const StepReport& report);

  std::size_t scans() const { return cpu_ms_.size(); }
  std::size_t claimed() const { return claimed_; }
  double seconds() const { return to_seconds(last_ - first_); }
  std::size_t scans_in(State state) const { return by_state_[static_cast<std::size_t>(state)]; }
  double median_step_ms() const;

  /// What the run was made with, for the file.
  struct About {
    std::string method, log, map, map_identity;
    int threads = 1;
    double elapsed_s = 0;                                         ///< wall time of the whole run
    std::vector<std::pair<std::string, std::uint64_t>> counters;  ///< what the log survived
    std::vector<std::string> warnings;
  };
  /// summary.json.
  std::string json(const About& about) const;

 private:
  std::vector<double> cpu_ms_;
  std::vector<double> wall_ms_;
  std::array<std::vector<double>, kStageNames.size()> stage_ms_;
  std::array<std::size_t, 8> by_state_{};
  std::size_t claimed_ = 0;
  std::size_t held_ = 0;
  std::size_t relocalizations_ = 0;
  TimeNs first_ = 0;
  TimeNs last_ = 0;
};

/// Largest resident set of this process so far, MB.
double peak_rss_mb();

}  // namespace holdfast::pipeline
