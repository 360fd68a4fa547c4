#include "holdfast/monitor/evidence/hypotheses.hpp"

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

/// What a hypothesis expects of the shares.
struct Expectation {
  Expected fitting, paired, through, unmapped;
};

/// `share` of what is usual (or more), for a hypothesis that is worth `worth` looks itself: no
/// narrower than what is known of the usual.
Expected about(double mean, double worth, const UsualLooks& usual) {
  return {mean, 1.0 / (1.0 / worth + 1.0 / usual.worth)};
}

double log_beta(double a, double b) { return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b); }

/// Beta-binomial, without the number of ways to choose, which is the same for all hypotheses.
double log_likelihood(double share, double looks, const Expected& expected) {
  const double mean = std::clamp(expected.mean, kLeastRate, 1.0 - kLeastRate);
  const double a = mean * expected.worth;
  const double b = (1.0 - mean) * expected.worth;
  const double seen = share * looks;
  return log_beta(seen + a, looks - seen + b) - log_beta(a, b);
}

/// Crowds hide, and are no walls: rays that end early cannot pass through more than usual. Changes
/// open and close some ways, and leave most as it is. At the border of the map and beyond, what it
/// has agrees as usual. At a wrong pose rays end anywhere.
Expectation expectation(Hypothesis hypothesis, const Looks& seen, const UsualLooks& usual) {
  const auto& [paired, through, unmapped, worth] = usual;
  const auto near = [&](double mean, double its_worth) { return about(mean, its_worth, usual); };
  switch (hypothesis) {
    case Hypothesis::kUsual:
      return {{kUsualFitting, 40}, {paired, worth}, {through, worth}, {unmapped, worth}};
    case Hypothesis::kChanged:
      return {
          {0.85, 30}, near(0.95 * paired, 60), near(through + 0.03, 30), near(unmapped + 0.03, 30)};
    case Hypothesis::kCrowded:
      return {{0.65, 5}, near(0.7 * paired, 8), {through, worth}, near(unmapped + 0.1, 6)};
    case Hypothesis::kWrongStrange: return {{0.6, 5}, near(0.6 * paired, 8), {0.2, 4}, {0.33, 2}};
    case Hypothesis::kWrongAlike:
      return {
          {0.7, 20}, near(0.9 * paired, 60), near(through + 0.05, 60), near(unmapped + 0.03, 60)};
    case Hypothesis::kOutside:
    case Hypothesis::kWrongOutside: break;
  }
  return {{0.85, 20}, near((1.0 - seen.unmapped) * paired, 20), near(through, 60), {0.5, 2}};
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
  const auto of = [&](Witness witness) -> LogLikelihoods& {
    return testimony[static_cast<std::size_t>(witness)];
  };
  for (std::size_t h = 0; h < kHypotheses; ++h) {
    const Expectation e = expectation(static_cast<Hypothesis>(h), seen, usual);
    of(Witness::kFitting)[h] =
        log_likelihood(seen.fitting, seen.paired * kIndependentLooks, e.fitting);
    of(Witness::kPaired)[h] = log_likelihood(seen.paired, kIndependentLooks, e.paired);
    of(Witness::kThrough)[h] = log_likelihood(seen.through, kIndependentLooks, e.through);
    of(Witness::kUnmapped)[h] = log_likelihood(seen.unmapped, kIndependentLooks, e.unmapped);
  }
}

void testify_way(double squared_distance, Testimony& testimony) {
  // The distance allows for more than chance does, so that it is mostly smaller than chi-square.
  const double x = std::clamp(squared_distance, kExpectedDistance, kLargestDistance);
  const double consistent = log_chi_square_6(x);
  // Of any size, but none that would be expected anyway: such a one proves nothing.
  const double anything =
      std::log((1.0 - kExpectedDistance / x) / (x * std::log(kLargestDistance)));
  LogLikelihoods& way = testimony[static_cast<std::size_t>(Witness::kWay)];
  for (std::size_t h = 0; h < kHypotheses; ++h) {
    const bool crowded = h == static_cast<std::size_t>(Hypothesis::kCrowded);
    const double astray = is_wrong(h) ? 1.0 : crowded ? kAstrayInACrowd : kOdometryAstray;
    way[h] = log_sum(consistent, std::log(astray) + anything);
  }
}

}  // namespace holdfast::monitor
