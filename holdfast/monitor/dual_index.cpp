#include "holdfast/monitor/dual_index.hpp"

#include <cmath>
#include <numbers>

namespace holdfast::monitor {

DualIndexVerdict DualIndexDetector::judge(const DualIndexInput& input) {
  DualIndexVerdict verdict;
  verdict.threshold_m = threshold_m();
  const SE3 motion = motion_to(input);
  verdict.jump_m = motion.translation.norm();
  verdict.jump_rad = so3::log(motion.rotation).norm();
  verdict.jumped = verdict.jump_m > config_.jump_m ||
                   verdict.jump_rad > config_.jump_deg * std::numbers::pi / 180;
  const double residual_m = input.mean_residual_m.value_or(0);
  verdict.candidate = input.too_few_matches || residual_m > verdict.threshold_m;
  consecutive_ = verdict.candidate && verdict.jumped ? consecutive_ + 1 : 0;
  verdict.anomaly = consecutive_ >= config_.confirm_scans ||
                    residual_m > config_.outright_factor * verdict.threshold_m;
  if (input.mean_residual_m) remember(residual_m);
  before_ = input.T_map_body;
  return verdict;
}

void DualIndexDetector::reset() {
  residuals_m_.clear();
  oldest_ = 0;
  before_.reset();
  consecutive_ = 0;
}

/// r_th = r_avg + alpha r_std.
double DualIndexDetector::threshold_m() const {
  if (config_.fixed_threshold_m > 0) return config_.fixed_threshold_m;
  const auto count = static_cast<double>(residuals_m_.size());
  if (count < config_.least_history_scans) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const double r : residuals_m_) sum += r;
  const double mean = sum / count;
  double squares = 0;
  for (const double r : residuals_m_) squares += (r - mean) * (r - mean);
  return mean + config_.residual_sigmas * std::sqrt(squares / count);
}

SE3 DualIndexDetector::motion_to(const DualIndexInput& input) const {
  if (config_.jump_from == "prediction") return input.T_map_predicted.inverse() * input.T_map_body;
  if (!before_) return {};
  if (config_.jump_from == "printed") return input.T_map_body * before_->inverse();
  return before_->inverse() * input.T_map_body;
}

void DualIndexDetector::remember(double residual_m) {
  if (residuals_m_.size() < static_cast<std::size_t>(config_.history_scans)) {
    residuals_m_.push_back(residual_m);
    return;
  }
  residuals_m_[oldest_] = residual_m;
  oldest_ = (oldest_ + 1) % residuals_m_.size();
}

}  // namespace holdfast::monitor
