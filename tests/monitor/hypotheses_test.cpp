#include "holdfast/monitor/evidence/hypotheses.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace holdfast::monitor {
namespace {

constexpr UsualLooks kRoom{0.92, 0.02, 0.0, 30};

double of(const Testimony& testimony, Witness witness, Hypothesis hypothesis) {
  return testimony[static_cast<std::size_t>(witness)][static_cast<std::size_t>(hypothesis)];
}

double sum(const Looks& seen, Hypothesis hypothesis) {
  Testimony testimony{};
  testify(seen, kRoom, testimony);
  return of(testimony, Witness::kFitting, hypothesis) +
         of(testimony, Witness::kPaired, hypothesis) +
         of(testimony, Witness::kThrough, hypothesis) +
         of(testimony, Witness::kUnmapped, hypothesis);
}

TEST(Hypotheses, AShareIsBetaBinomialAboutWhatIsUsual) {
  Testimony testimony{};
  testify({0, 0.5, 0, 0}, {0.5, 0, 0, 2}, testimony);
  // a = b = 1: each number of 30 is as likely, so that what is left without the number of ways to
  // choose 15 of 30 is B(16, 16) = 15! 15! / 31!.
  EXPECT_NEAR(of(testimony, Witness::kPaired, Hypothesis::kUsual),
              2 * std::lgamma(16.0) - std::lgamma(32.0), 1e-9);
}

TEST(Hypotheses, EachIsTheLikeliestWhereItShouldBe) {
  struct Case {
    Looks seen;
    Hypothesis hypothesis;
  };
  for (const auto& [seen, expected] : {
           Case{{0.87, 0.92, 0.02, 0.00}, Hypothesis::kUsual},
           Case{{0.80, 0.50, 0.01, 0.10}, Hypothesis::kCrowded},
           Case{{0.85, 0.46, 0.01, 0.50}, Hypothesis::kOutside},
           Case{{0.85, 0.87, 0.05, 0.03}, Hypothesis::kChanged},
           Case{{0.50, 0.60, 0.30, 0.10}, Hypothesis::kWrongStrange},
           Case{{0.68, 0.83, 0.08, 0.02}, Hypothesis::kWrongAlike},
       }) {
    for (std::size_t h = 0; h < kHypotheses; ++h) {
      EXPECT_LE(sum(seen, static_cast<Hypothesis>(h)), sum(seen, expected) + 1e-12)
          << seen.fitting << ", hypothesis " << h;
    }
  }
}

TEST(Hypotheses, OutsideOfTheMapNothingTellsRightFromWrong) {
  for (const Looks seen : {Looks{0, 0, 0, 1}, Looks{0.8, 0.4, 0.01, 0.6}}) {
    EXPECT_DOUBLE_EQ(sum(seen, Hypothesis::kOutside), sum(seen, Hypothesis::kWrongOutside));
  }
}

TEST(Hypotheses, AnOdometryThatGoesAlongProvesNothingAndOneThatDoesNotSpeaksAgainstThePose) {
  const auto against = [](double squared_distance) {
    Testimony testimony{};
    testify_way(squared_distance, testimony);
    return of(testimony, Witness::kWay, Hypothesis::kWrongStrange) -
           of(testimony, Witness::kWay, Hypothesis::kUsual);
  };
  EXPECT_EQ(against(0.1), 0);
  EXPECT_LT(against(12), 1);
  EXPECT_GT(against(40), 5);
  // Never more than the odometry is to be believed: it is astray once in a thousand.
  EXPECT_LE(against(1e5), std::log(1000) + 1e-6);
  for (double x = 1; x < 1e5; x *= 1.5) EXPECT_LE(against(x), against(1.5 * x) + 1e-9) << x;
}

}  // namespace
}  // namespace holdfast::monitor
