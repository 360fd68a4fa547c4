#include "evaluation/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace holdfast::evaluation {
namespace {

TEST(Statistics, OfKnownNumbersAreTheirClosedForms) {
  const ErrorStatistics s = error_statistics({4, 1, 3, 2});
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(30.0 / 4));
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.p95, 3.85);
  EXPECT_DOUBLE_EQ(s.max, 4);
}

TEST(Statistics, OfNothingAreNotKnown) {
  EXPECT_TRUE(std::isnan(error_statistics({}).rmse));
  EXPECT_TRUE(std::isnan(error_statistics({}).max));
  EXPECT_TRUE(std::isnan(Share{}.value()));
  EXPECT_TRUE(std::isnan(interval_95({}).low));
}

TEST(Interval, NothingWrongInFourHundredProvesThreeQuartersOfAPercent) {
  const Interval interval = interval_95({0, 400});
  EXPECT_EQ(interval.low, 0);
  EXPECT_NEAR(interval.high, 1 - std::pow(0.05, 1.0 / 400), 1e-12);
}

TEST(Interval, OfAllIsTheMirrorOfNone) {
  EXPECT_NEAR(interval_95({50, 50}).low, std::pow(0.05, 1.0 / 50), 1e-12);
  EXPECT_EQ(interval_95({50, 50}).high, 1);
}

/// P(X >= k) for X binomial, by adding up terms.
double upper_tail(int k, int n, double p) {
  double sum = 0;
  for (int i = k; i <= n; ++i)
    sum += std::exp(std::lgamma(n + 1) - std::lgamma(i + 1) - std::lgamma(n - i + 1)) *
           std::pow(p, i) * std::pow(1 - p, n - i);
  return sum;
}

TEST(Interval, LeavesTwoAndAHalfPercentOnEachSide) {
  for (const int k : {1, 7, 20, 39}) {
    const Interval interval = interval_95({static_cast<std::size_t>(k), 40});
    EXPECT_NEAR(upper_tail(k, 40, interval.low), 0.025, 1e-9) << k;
    EXPECT_NEAR(1 - upper_tail(k + 1, 40, interval.high), 0.025, 1e-9) << k;
  }
}

TEST(Interval, HoldsForAHundredThousandScans) {
  // The normal approximation is good to 1e-5 here.
  const Interval interval = interval_95({50'000, 100'000});
  const double half = 1.959964 * std::sqrt(0.25 / 100'000);
  EXPECT_NEAR(interval.low, 0.5 - half, 2e-5);
  EXPECT_NEAR(interval.high, 0.5 + half, 2e-5);
}

}  // namespace
}  // namespace holdfast::evaluation
