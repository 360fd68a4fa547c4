#include "holdfast/pipeline/health/dual_index_localizer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace holdfast::pipeline {
namespace {

constexpr int kFewestMatches = 30;  // N_E + N_F (4.1.1)

Evidence in_words(const monitor::DualIndexVerdict& v, double residual_m, int matches) {
  return {"residual", residual_m > 0 ? std::log(residual_m / v.threshold_m) : 0.0,
          fmt::format("mean residual {:.3f} m against {:.3f} m, {} matches, a jump of {:.2f} m and "
                      "{:.1f} degrees",
                      residual_m, v.threshold_m, matches, v.jump_m,
                      v.jump_rad * 180.0 / std::numbers::pi)};
}

}  // namespace

StepReport DualIndexLocalizer::add_scan(const Scan& scan) {
  StepReport report = localizer_->add_scan(scan);
  if (report.state == State::kInitializing) return report;
  monitor::DualIndexInput input;
  input.T_map_body = report.T_map_body;
  input.T_map_predicted = report.T_map_predicted;
  if (report.matches > 0) input.mean_residual_m = report.mean_abs_residual_m;
  input.too_few_matches = report.matches < kFewestMatches;
  const monitor::DualIndexVerdict verdict = detector_.judge(input);
  calm_ = verdict.candidate ? 0 : calm_ + 1;
  if (verdict.anomaly) lost_ = true;
  if (lost_ && calm_ >= config_.confirm_scans) lost_ = false;
  if (!lost_) return report;
  report.alarm = true;
  report.evidence = {in_words(verdict, report.mean_abs_residual_m, report.matches)};
  report.state = State::kLost;
  report.reason = "the scan fits the map worse than before (dual index)";
  return report;
}

}  // namespace holdfast::pipeline
