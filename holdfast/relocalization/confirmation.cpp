#include "holdfast/relocalization/confirmation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace holdfast::relocalization {
namespace {

// Candidates of two searches are the same if the odometry links them to within this: what a
// refinement, and some metres of odometry, may be off.
constexpr double kSameM = 0.5;
constexpr double kSameRad = 5.0 * std::numbers::pi / 180.0;
constexpr double kNewsAfterM = 1.0;  // as in monitor::BeliefConfig
constexpr double kNewsAfterS = 5.0;
constexpr double kAbsent = -2.0;       // log odds of a pose that a search did not come upon
constexpr double kForgotten = -12.0;   // log odds from which one no longer matters
constexpr double kMostLogOdds = 12.0;  // more would outweigh any doubt that comes later
constexpr double kOpenSigmaM = 0.2;    // a direction known worse than that is not determined

/// ln of how much likelier a candidate is than none of them, as its search told.
double log_odds(const Candidate& candidate, double p_none) {
  constexpr double kLeast = 1e-9;
  return std::log(std::max(candidate.probability, kLeast) / std::max(p_none, kLeast));
}

}  // namespace

Confirmation::Hypothesis* Confirmation::find(const SE3& T_map_odom) {
  for (Hypothesis& h : hypotheses_) {
    const SE3 between = h.T_map_odom.inverse() * T_map_odom;
    // Where the robot is, not where its odometry began, which is a lever away.
    const double apart =
        (h.T_map_odom * last_T_odom_body_.translation - T_map_odom * last_T_odom_body_.translation)
            .norm();
    if (apart < kSameM && so3::log(between.rotation).norm() < kSameRad) return &h;
  }
  return nullptr;
}

void Confirmation::hear(const SearchReport& report, const SE3& T_odom_body,
                        double seconds_since_last) {
  if (!report.any_fits()) {
    for (Hypothesis& h : hypotheses_) h.seen_now = false;
    return;
  }
  const double way_m = (T_odom_body.translation - last_T_odom_body_.translation).norm();
  const double news =
      any_ ? -std::expm1(-way_m / kNewsAfterM - seconds_since_last / kNewsAfterS) : 1.0;
  last_T_odom_body_ = T_odom_body;
  any_ = true;
  for (Hypothesis& h : hypotheses_) h.seen_now = false;
  const double p_none = report.p_none();
  for (const Candidate& c : report.candidates) {
    const SE3 T_map_odom = c.T_map_body * T_odom_body.inverse();
    Hypothesis* known = find(T_map_odom);
    if (known != nullptr && known->seen_now) continue;  // two modes of one pose: the better one
    if (known == nullptr) {
      hypotheses_.push_back({T_map_odom, c, absent_log_odds_});
      known = &hypotheses_.back();
    }
    const double sum = known->log_odds + news * log_odds(c, p_none);
    *known = {T_map_odom, c, std::min(sum, kMostLogOdds), true, report.fits(c)};
  }
  for (Hypothesis& h : hypotheses_) h.log_odds += h.seen_now ? 0.0 : news * kAbsent;
  absent_log_odds_ = std::max(absent_log_odds_ + news * kAbsent, kForgotten);
  std::erase_if(hypotheses_, [](const Hypothesis& h) { return h.log_odds <= kForgotten; });
}

double Confirmation::probability(const Hypothesis& hypothesis) const {
  double sum = 1.0;  // elsewhere
  for (const Hypothesis& h : hypotheses_) sum += std::exp(h.log_odds);
  return std::exp(hypothesis.log_odds) / sum;
}

std::optional<Confirmed> Confirmation::confirmed() const {
  for (const Hypothesis& h : hypotheses_) {
    const double p = probability(h);
    const bool stands_alone = h.seen_now && h.fits_now;
    if (stands_alone && p >= accept_probability_ && h.last.weakest_sigma_m <= kOpenSigmaM) {
      return Confirmed{h.last, p};
    }
  }
  return std::nullopt;
}

}  // namespace holdfast::relocalization
