#include "holdfast/monitor/evidence/onset.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::monitor {
namespace {

constexpr TimeNs kLongestGap = kSecond / 2;  // over which a change is sudden
constexpr double kLeastShare = 0.4;          // below, there is little that could drop

// The drop between two scans at a right pose, as a share of what agreed before: a sum of two
// Laplace densities, mostly noise, and corners and people now and then (docs/decisions/0008). If
// the robot was carried, every drop is as likely.
constexpr double kNoiseScale = 0.01;
constexpr double kSceneScale = 0.055;
constexpr double kSceneShare = 0.03;
constexpr double kMostLogRatio = 9.0;

double laplace(double x, double scale) { return std::exp(-std::abs(x) / scale) / (2.0 * scale); }

double log_ratio(double drop) {
  const double right =
      (1.0 - kSceneShare) * laplace(drop, kNoiseScale) + kSceneShare * laplace(drop, kSceneScale);
  // A rise is no sign of having been carried, however sudden: it may be the way out of a crowd.
  if (drop < 0) return std::min(0.0, -std::log(right));
  return std::min(kMostLogRatio, -std::log(right));
}

}  // namespace

Onset OnsetWatch::watch(TimeNs t, std::optional<double> agreeing_share, bool odometry_broke) {
  Onset onset;
  onset.odometry_broke = odometry_broke;
  const auto& reference = before_[0];
  if (agreeing_share && reference && t - reference->t <= kLongestGap) {
    onset.drop = (reference->share - *agreeing_share) / std::max(kLeastShare, reference->share);
    onset.log_ratio = log_ratio(onset.drop);
  }
  before_[0] = before_[1];
  before_[1] = agreeing_share ? std::optional(Seen{t, *agreeing_share}) : std::nullopt;
  return onset;
}

}  // namespace holdfast::monitor
