#include "holdfast/monitor/hypotheses.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::monitor {
namespace {

constexpr double kIndependentLooks = 30;
constexpr double kLeastRate = 0.003;  // of anything: a mean of nothing would exclude the first one

// Of the way: how often the odometry is astray at a right pose, and how far a distance may be.
constexpr double kOdometryAstray = 1e-3;
constexpr double kAstrayInACrowd = 0.02;
constexpr double kExpectedDistance = 6;  // of a chi-square with 6 degrees of freedom
constexpr double kLargestDistance = 1e6;

/// A share that is expected: `worth` looks with this mean have been seen before, as it were.
struct Expected {
  double mean = 0;
  double worth = 0;
};

/// What a hypothesis expects of the three shares.
struct Expectation {
  Expected agreeing, through, unmapped;
};

/// `share` of what is usual (or more), for a hypothesis that is worth `worth` looks itself: no
/// narrower than what is known of the usual.
Expected about(double mean, double worth, const UsualLooks& usual) {
  return {mean, 1.0 / (1.0 / worth + 1.0 / usual.worth)};
}

double log_beta(double a, double b) { return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b); }

/// Beta-binomial, without the number of ways to choose, which is the same for all hypotheses.
double log_likelihood(double share, const Expected& expected) {
  const double mean = std::clamp(expected.mean, kLeastRate, 1.0 - kLeastRate);
  const double a = mean * expected.worth;
  const double b = (1.0 - mean) * expected.worth;
  const double seen = share * kIndependentLooks;
  return log_beta(seen + a, kIndependentLooks - seen + b) - log_beta(a, b);
}

/// Crowds hide, and are no walls: rays that end early cannot pass through more than usual. Changes
/// open and close some ways, and leave most as it is. At the border of the map and beyond, what it
/// has agrees as usual. At a wrong pose rays end anywhere.
Expectation expectation(Hypothesis hypothesis, const Looks& seen, const UsualLooks& usual) {
  const auto& [agreeing, through, unmapped] = usual.mean;
  const auto near = [&](double mean, double worth) { return about(mean, worth, usual); };
  switch (hypothesis) {
    case Hypothesis::kUsual:
      return {{agreeing, usual.worth}, {through, usual.worth}, {unmapped, usual.worth}};
    case Hypothesis::kChanged:
      return {near(0.9 * agreeing, 60), near(through + 0.03, 30), near(unmapped + 0.03, 30)};
    case Hypothesis::kCrowded:
      return {near(0.65 * agreeing, 8), {through, usual.worth}, near(unmapped + 0.1, 6)};
    case Hypothesis::kWrongStrange:
      return {near(0.45 * agreeing, 8), {0.2, 4}, {0.33, 2}};
    case Hypothesis::kWrongAlike:
      return {near(0.75 * agreeing, 60), near(through + 0.05, 60), near(unmapped + 0.03, 60)};
    case Hypothesis::kOutside:
    case Hypothesis::kWrongOutside:
      break;
  }
  return {near((1.0 - seen.unmapped) * agreeing, 20), near(through, 60), {0.5, 2}};
}

/// Of a chi-square variable with 6 degrees of freedom.
double log_chi_square_6(double x) { return 2.0 * std::log(x) - 0.5 * x - std::log(16.0); }

double log_sum(double a, double b) {
  const double larger = std::max(a, b);
  if (std::isinf(std::min(a, b))) return larger;
  return larger + std::log1p(std::exp(std::min(a, b) - larger));
}

}  // namespace

void testify(const Looks& seen, const UsualLooks& usual, Testimony& testimony) {
  for (std::size_t h = 0; h < kHypotheses; ++h) {
    const Expectation e = expectation(static_cast<Hypothesis>(h), seen, usual);
    testimony[static_cast<std::size_t>(Witness::kAgreeing)][h] =
        log_likelihood(seen.agreeing, e.agreeing);
    testimony[static_cast<std::size_t>(Witness::kThrough)][h] =
        log_likelihood(seen.through, e.through);
    testimony[static_cast<std::size_t>(Witness::kUnmapped)][h] =
        log_likelihood(seen.unmapped, e.unmapped);
  }
}

void testify_way(double squared_distance, Testimony& testimony) {
  // The distance allows for more than chance does, so that it is mostly smaller than chi-square.
  const double x = std::clamp(squared_distance, kExpectedDistance, kLargestDistance);
  const double consistent = log_chi_square_6(x);
  // Of any size, but none that would be expected anyway: such a one proves nothing.
  const double anything = std::log((1.0 - kExpectedDistance / x) / (x * std::log(kLargestDistance)));
  LogLikelihoods& way = testimony[static_cast<std::size_t>(Witness::kWay)];
  for (std::size_t h = 0; h < kHypotheses; ++h) {
    const bool crowded = h == static_cast<std::size_t>(Hypothesis::kCrowded);
    const double astray = is_wrong(h) ? 1.0 : crowded ? kAstrayInACrowd : kOdometryAstray;
    way[h] = log_sum(consistent, std::log(astray) + anything);
  }
}

}  // namespace holdfast::monitor
