#include "holdfast/monitor/evidence/onset.hpp"

#include <gtest/gtest.h>

namespace holdfast::monitor {
namespace {

constexpr TimeNs kScan = kSecond / 10;

/// The onset at the last of scans 0.1 s apart.
Onset after(const std::vector<double>& shares) {
  OnsetWatch watch;
  Onset onset;
  TimeNs t = kSecond;
  for (const double share : shares) onset = watch.watch(t += kScan, share, false);
  return onset;
}

TEST(Onset, IsTheDropAgainstTwoScansBefore) {
  EXPECT_DOUBLE_EQ(after({0.8, 0.6, 0.4}).drop, 0.5);
  EXPECT_DOUBLE_EQ(after({0.8, 0.8, 0.8, 0.6}).drop, 0.25);
}

TEST(Onset, ThatCountsForNothingBeforeTwoScans) {
  EXPECT_EQ(after({0.8}).log_ratio, 0);
  EXPECT_EQ(after({0.8, 0.1}).log_ratio, 0);
}

TEST(Onset, NoiseSpeaksAgainstItAndAGreatDropForIt) {
  EXPECT_LT(after({0.8, 0.8, 0.8}).log_ratio, -3);
  EXPECT_LT(after({0.80, 0.80, 0.79}).log_ratio, -2);
  EXPECT_GT(after({0.8, 0.6, 0.4}).log_ratio, 8);
  EXPECT_GT(after({0.8, 0.6, 0.4}).log_ratio, after({0.8, 0.7, 0.6}).log_ratio);
}

TEST(Onset, ARiseIsNone) { EXPECT_LE(after({0.3, 0.5, 0.8}).log_ratio, 0); }

TEST(Onset, WhatHappensInADarkSecondIsNotSudden) {
  OnsetWatch watch;
  watch.watch(kSecond, 0.8, false);
  watch.watch(kSecond + kScan, 0.8, false);
  EXPECT_EQ(watch.watch(3 * kSecond, 0.2, false).log_ratio, 0);
  OnsetWatch blind;
  blind.watch(kSecond, 0.8, false);
  blind.watch(kSecond + kScan, 0.8, false);
  blind.watch(kSecond + 2 * kScan, std::nullopt, false);
  blind.watch(kSecond + 3 * kScan, std::nullopt, false);
  EXPECT_EQ(blind.watch(kSecond + 4 * kScan, 0.2, false).log_ratio, 0);
}

}  // namespace
}  // namespace holdfast::monitor
