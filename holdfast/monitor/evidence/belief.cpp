#include "holdfast/monitor/evidence/belief.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::monitor {
namespace {

using Probabilities = std::array<double, kHypotheses>;

// What kind of right, and of wrong, before anything was seen. A world changes from one kind to
// another within some seconds of driving.
constexpr Probabilities kKinds = {0.84, 0.03, 0.06, 0.07, 0.6, 0.33, 0.07};
constexpr double kOtherKindPerS = 0.02;
constexpr double kBrokeInACrowd = 0.99;  // of the breaks in a crowd: the people's doing
constexpr double kNewsOfWay = 0.2;       // a way of some metres is new after some metres
constexpr double kLeast = 1e-30;

Probabilities with_wrong(double wrong) {
  Probabilities p{};
  for (std::size_t h = 0; h < kHypotheses; ++h) {
    p[h] = kKinds[h] * (is_wrong(h) ? wrong : 1.0 - wrong);
  }
  return p;
}

double in(double per_s, double seconds) { return -std::expm1(-per_s * seconds); }

/// p * exp(share * testimony), normalised.
Probabilities weighed(const Probabilities& p, const LogLikelihoods& testimony, double share) {
  Probabilities q{};
  const double largest = *std::max_element(testimony.begin(), testimony.end());
  double sum = 0;
  for (std::size_t h = 0; h < kHypotheses; ++h) {
    q[h] = std::max(kLeast, p[h] * std::exp(share * (testimony[h] - largest)));
    sum += q[h];
  }
  for (double& value : q) value /= sum;
  return q;
}

/// Of a probability, after evidence with this log ratio for it.
double weighed(double probability, double log_ratio) {
  const double odds = probability / (1.0 - probability) * std::exp(log_ratio);
  return odds / (1.0 + odds);
}

double sum_of_wrong(const Probabilities& p) {
  double sum = 0;
  for (std::size_t h = 0; h < kHypotheses; ++h) sum += is_wrong(h) ? p[h] : 0.0;
  return sum;
}

}  // namespace

Belief::Belief(const BeliefConfig& config)
    : config_(config), history_(with_wrong(config.wrong_at_start)), now_(history_) {}

void Belief::pass(double seconds, double way_m, const Onset& onset) {
  const double wrong = sum_of_wrong(history_);
  const double becomes = p_carried(seconds, onset);
  const double found = in(config_.found_again_per_s, seconds);
  const double other = in(kOtherKindPerS, seconds);
  for (std::size_t h = 0; h < kHypotheses; ++h) {
    const double group = is_wrong(h) ? wrong : 1.0 - wrong;
    const double stays = (1.0 - other) * history_[h] + other * kKinds[h] * group;
    const double leaves = is_wrong(h) ? found : becomes;
    const double comes = is_wrong(h) ? becomes * (1.0 - wrong) : found * wrong;
    history_[h] = (1.0 - leaves) * stays + kKinds[h] * comes;
  }
  now_ = history_;
  news_ = -std::expm1(-way_m / config_.news_after_m - seconds / config_.news_after_s);
}

/// Having been right. An odometry that breaks says that the robot was carried, but for one that has
/// nothing but people to go by: it breaks of itself.
double Belief::p_carried(double seconds, const Onset& onset) const {
  double expected = in(config_.wrong_per_s, seconds);
  if (onset.odometry_broke) {
    const double right = 1.0 - sum_of_wrong(history_);
    const double crowded = history_[static_cast<std::size_t>(Hypothesis::kCrowded)];
    expected = config_.wrong_after_break * (1.0 - kBrokeInACrowd * crowded / right);
  }
  return weighed(expected, onset.log_ratio);
}

void Belief::hear(const LogLikelihoods& scene, const LogLikelihoods& way) {
  now_ = weighed(weighed(history_, scene, 1.0), way, 1.0);
  history_ = weighed(weighed(history_, scene, news_), way, kNewsOfWay * news_);
}

double Belief::p_wrong() const { return sum_of_wrong(now_); }

double Belief::log_ratio(const LogLikelihoods& testimony) const {
  const double largest = *std::max_element(testimony.begin(), testimony.end());
  double right = 0, wrong = 0, all_wrong = 0;
  for (std::size_t h = 0; h < kHypotheses; ++h) {
    (is_wrong(h) ? wrong : right) += now_[h] * std::exp(testimony[h] - largest);
    all_wrong += is_wrong(h) ? now_[h] : 0.0;
  }
  return std::log(std::max(wrong, kLeast) / std::max(all_wrong, kLeast)) -
         std::log(std::max(right, kLeast) / std::max(1.0 - all_wrong, kLeast));
}

}  // namespace holdfast::monitor
