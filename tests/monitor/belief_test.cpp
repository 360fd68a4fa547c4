#include "holdfast/monitor/evidence/belief.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace holdfast::monitor {
namespace {

constexpr double kScan = 0.1;

/// Says so much more of a wrong pose than of a right one.
LogLikelihoods against(double log_ratio) {
  LogLikelihoods testimony{};
  for (std::size_t h = 0; h < kHypotheses; ++h) testimony[h] = is_wrong(h) ? log_ratio : 0.0;
  return testimony;
}

double logit(double p) { return std::log(p / (1 - p)); }

TEST(Belief, BeginsWithWhatTheConfigurationSays) {
  EXPECT_NEAR(Belief(BeliefConfig{}).p_wrong(), 0.05, 1e-12);
}

TEST(Belief, TheNewestScanCountsInFull) {
  Belief belief{BeliefConfig{}};
  belief.hear(against(3), {});
  EXPECT_NEAR(logit(belief.p_wrong()), logit(0.05) + 3, 1e-9);
}

TEST(Belief, ARobotThatStandsDoesNotBecomeSurerByLookingAtTheSameView) {
  BeliefConfig config;
  config.news_after_s = 1000;
  config.wrong_per_s = config.found_again_per_s = 1e-9;
  Belief belief(config);
  for (int i = 0; i < 50; ++i) {
    belief.pass(kScan, 0, {});
    belief.hear(against(-1), {});
  }
  EXPECT_NEAR(logit(belief.p_wrong()), logit(0.05) - 1, 0.01);
}

TEST(Belief, ARobotThatDrivesHearsSomethingNewEveryMetre) {
  BeliefConfig config;
  config.news_after_s = 1000;
  config.wrong_per_s = config.found_again_per_s = 1e-12;
  Belief belief(config);
  belief.hear(against(1), {});
  for (int i = 0; i < 1000; ++i) {
    belief.pass(kScan, 0.01, {});
    belief.hear(against(-0.2), {});
  }
  // 10 m of -0.2 each; the first scan's word is not forgotten, but it was of one place.
  EXPECT_NEAR(logit(belief.p_wrong()), logit(0.05) - 2.2 + 1, 0.1);
}

TEST(Belief, WhatWasSeenBeforeDoesNotHideThatTheRobotWasCarried) {
  Belief belief{BeliefConfig{}};
  for (int i = 0; i < 600; ++i) {
    belief.pass(kScan, 0.1, {});
    belief.hear(against(-8), {});
  }
  ASSERT_LT(belief.p_wrong(), 1e-6);
  belief.pass(kScan, 0.1, {true, 0, 0});
  belief.hear(against(3), {});
  EXPECT_NEAR(logit(belief.p_wrong()), logit(BeliefConfig{}.wrong_after_break) + 3, 0.1);
}

TEST(Belief, ADropOfWhatAgreesIsHeldAgainstHowOftenPosesBecomeWrong) {
  BeliefConfig config;
  config.wrong_at_start = 1e-6;
  Belief belief(config);
  belief.pass(kScan, 0, {false, 0.5, std::log(1e5)});
  // 1e-4 a second, in a tenth of one, 1e5 times as likely: even chances.
  EXPECT_NEAR(belief.p_wrong(), 0.5, 0.01);
}

TEST(Belief, ProbabilitiesSumToOneWhateverIsSaid) {
  Belief belief{BeliefConfig{}};
  for (const double say : {0.0, 50.0, -800.0, 900.0, 1e-3}) {
    belief.pass(kScan, 0.3, {say > 0, 0, say > 100 ? 9.0 : -5.0});
    belief.hear(against(say), {});
    double sum = 0;
    for (std::size_t h = 0; h < kHypotheses; ++h) {
      const double p = belief.probability(static_cast<Hypothesis>(h));
      EXPECT_GE(p, 0);
      sum += p;
    }
    EXPECT_NEAR(sum, 1, 1e-9);
  }
}

TEST(Belief, TheLogRatioOfATestimonyIsTheChangeOfOdds) {
  const Belief belief{BeliefConfig{}};
  EXPECT_NEAR(belief.log_ratio(against(2.5)), 2.5, 1e-9);
}

}  // namespace
}  // namespace holdfast::monitor
