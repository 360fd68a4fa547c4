#include "holdfast/monitor/health_monitor.hpp"

namespace holdfast::monitor {
namespace {

constexpr TimeNs kOnsetMemory = 3 * kSecond;

}  // namespace

Health HealthMonitor::judge(const HealthInput& input) {
  Health health;
  const double seconds = before_ == 0 ? 0.0 : to_seconds(input.t - before_);
  before_ = input.t;
  const Onset onset =
      watch_.watch(input.t, input.looks ? std::optional(input.looks->agreeing()) : std::nullopt,
                   input.odometry_broke);
  remember(onset, input.t);
  health.onset = onset_;
  belief_.pass(seconds, input.way_m, onset);
  hear(input, health);
  health.p_wrong = belief_.p_wrong();
  health.p_outside = belief_.probability(Hypothesis::kOutside);
  health.p_hidden =
      belief_.probability(Hypothesis::kChanged) + belief_.probability(Hypothesis::kCrowded);
  health.verdict = last_ = verdict(health.p_wrong);
  if (input.looks && last_ == Verdict::kHealthy) run_.learn(*input.looks);
  return health;
}

void HealthMonitor::remember(const Onset& onset, TimeNs t) {
  const bool stronger = onset.odometry_broke != onset_.odometry_broke
                            ? onset.odometry_broke
                            : onset.log_ratio >= onset_.log_ratio;
  if (!stronger && t < onset_time_ + kOnsetMemory) return;
  onset_ = onset;
  onset_time_ = t;
}

void HealthMonitor::hear(const HealthInput& input, Health& health) {
  Testimony testimony{};
  health.usual = input.usual ? input.usual : run_.looks();
  health.seen = input.looks;
  if (input.looks && health.usual) testify(*input.looks, *health.usual, testimony);
  if (input.way_squared_distance) testify_way(*input.way_squared_distance, testimony);
  constexpr auto kWay = static_cast<std::size_t>(Witness::kWay);
  LogLikelihoods scene{};
  for (std::size_t w = 0; w < testimony.size(); ++w) {
    health.log_ratio[w] = belief_.log_ratio(testimony[w]);
    if (w == kWay) continue;
    for (std::size_t h = 0; h < kHypotheses; ++h) scene[h] += testimony[w][h];
  }
  belief_.hear(scene, testimony[kWay]);
}

/// A pose that is lost is not found by a little less doubt.
Verdict HealthMonitor::verdict(double p_wrong) const {
  if (p_wrong >= config_.lost_p) return Verdict::kLost;
  if (p_wrong < config_.suspect_p) return Verdict::kHealthy;
  return last_ == Verdict::kLost ? Verdict::kLost : Verdict::kSuspect;
}

}  // namespace holdfast::monitor
