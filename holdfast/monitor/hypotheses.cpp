#include "holdfast/monitor/hypotheses.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::monitor {
namespace {

constexpr double kIndependentLooks = 30;
constexpr double kLeastRate = 0.003;  // of anything: a mean of nothing would exclude the first one

// Of the way: how often the odometry is astray at a right pose, and how far a distance may be.
constexpr double kOdometryAstray = 1e-3;
constexpr double kWayGoesAlong = 0.5;  // of the wrong places
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
/// open and close some ways, and leave most as it is. At a wrong pose rays end anywhere.
Expectation expectation(Hypothesis hypothesis, const UsualLooks& usual) {
  const auto& [agreeing, through, unmapped] = usual.mean;
  switch (hypothesis) {
    case Hypothesis::kUsual:
      return {{agreeing, usual.worth}, {through, usual.worth}, {unmapped, usual.worth}};
    case Hypothesis::kChanged:
      return {{0.9 * agreeing, 20}, {through + 0.03, 15}, {unmapped + 0.03, 15}};
    case Hypothesis::kCrowded:
      return {{0.65 * agreeing, 6}, {through, usual.worth}, {unmapped + 0.02, 12}};
    case Hypothesis::kWrongStrange:
      return {{0.45 * agreeing, 6}, {0.2, 4}, {0.33, 2}};
    case Hypothesis::kWrongAlike:
      return {{0.75 * agreeing, 20}, {through + 0.05, 20}, {unmapped + 0.03, 20}};
    case Hypothesis::kOutside:
    case Hypothesis::kWrongOutside:
      break;
  }
  return {{0.4 * agreeing, 4}, {through, 20}, {0.67, 3}};
}

/// Of a chi-square variable with 6 degrees of freedom.
double log_chi_square_6(double x) { return 2.0 * std::log(x) - 0.5 * x - std::log(16.0); }

double log_sum(double a, double b) {
  const double larger = std::max(a, b);
  return larger + std::log1p(std::exp(std::min(a, b) - larger));
}

}  // namespace

void testify(const Looks& seen, const UsualLooks& usual, Testimony& testimony) {
  for (std::size_t h = 0; h < kHypotheses; ++h) {
    const Expectation e = expectation(static_cast<Hypothesis>(h), usual);
    testimony[static_cast<std::size_t>(Witness::kAgreeing)][h] =
        log_likelihood(seen.agreeing, e.agreeing);
    testimony[static_cast<std::size_t>(Witness::kThrough)][h] =
        log_likelihood(seen.through, e.through);
    testimony[static_cast<std::size_t>(Witness::kUnmapped)][h] =
        log_likelihood(seen.unmapped, e.unmapped);
  }
}

void testify_way(double squared_distance, Testimony& testimony) {
  const double x = std::clamp(squared_distance, 1.0, kLargestDistance);
  const double consistent = log_chi_square_6(x);
  const double anything = -std::log(x * std::log(kLargestDistance));
  const double right = log_sum(std::log1p(-kOdometryAstray) + consistent,
                               std::log(kOdometryAstray) + anything);
  const double wrong = log_sum(std::log(kWayGoesAlong) + consistent,
                               std::log1p(-kWayGoesAlong) + anything);
  LogLikelihoods& way = testimony[static_cast<std::size_t>(Witness::kWay)];
  for (std::size_t h = 0; h < kHypotheses; ++h) way[h] = is_wrong(h) ? wrong : right;
}

}  // namespace holdfast::monitor
