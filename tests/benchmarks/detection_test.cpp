#include <gtest/gtest.h>

#include <algorithm>

#include "benchmarks/detection/detection_score.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr TimeNs kStart = 100 * kSecond;

/// 20 s of scans, 0.1 s apart, trusted, wrong from `wrong_from_s` on.
MonitoredDrive drive(double wrong_from_s, Mishap mishap = Mishap::kKidnap) {
  MonitoredDrive drive;
  drive.mishap = mishap;
  drive.event = kStart + from_seconds(wrong_from_s);
  for (int i = 0; i < 200; ++i) {
    ScanHealth scan;
    scan.t = kStart + i * kSecond / 10;
    scan.trusted = scan.moving = true;
    scan.wrong = i >= 10 * wrong_from_s - 1e-9;
    drive.scans.push_back(scan);
  }
  return drive;
}

Alarms at(std::initializer_list<int> scans) {
  Alarms alarms(200, false);
  for (const int i : scans) alarms[static_cast<std::size_t>(i)] = true;
  return alarms;
}

TEST(DetectionScore, AKidnapIsFoundByTheFirstAlarmAfterIt) {
  DetectionScore score;
  score.add(drive(10), at({103, 120}));
  EXPECT_EQ(score.missed.count, 0U);
  EXPECT_EQ(score.missed.of, 1U);
  ASSERT_EQ(score.delays_s.size(), 1U);
  EXPECT_NEAR(score.delays_s[0], 0.3, 1e-9);
  EXPECT_EQ(score.false_alarms, 0U);
  EXPECT_NEAR(score.right_s, 9.9, 1e-9);
}

TEST(DetectionScore, AKidnapWithoutAnAlarmInFiveSecondsIsMissed) {
  DetectionScore score;
  score.add(drive(10), at({170}));
  EXPECT_EQ(score.missed.count, 1U);
  EXPECT_TRUE(score.delays_s.empty());
}

TEST(DetectionScore, AnAlarmAtARightPoseIsFalseButNotASecondBeforeItIsWrong) {
  DetectionScore score;
  score.add(drive(10), at({20, 21, 22, 50, 95, 101}));
  EXPECT_EQ(score.false_alarms, 2U);  // 20 to 22 is one
}

TEST(DetectionScore, ADriveThatStaysRightHasNoEvent) {
  DetectionScore score;
  score.add(drive(30), at({5, 199}));
  EXPECT_EQ(score.missed.of, 0U);
  EXPECT_EQ(score.false_alarms, 2U);
  EXPECT_NEAR(score.right_s, 19.9, 1e-9);
  EXPECT_NEAR(score.false_alarms_per_h(), 2 * 3600 / 19.9, 1e-6);
}

TEST(DetectionScore, AfterAWrongStartOnlyMotionCounts) {
  MonitoredDrive started = drive(0, Mishap::kWrongStart);
  for (int i = 0; i < 80; ++i) started.scans[static_cast<std::size_t>(i)].moving = false;
  DetectionScore score;
  score.add(started, at({90}));
  ASSERT_EQ(score.delays_s.size(), 1U);
  EXPECT_NEAR(score.delays_s[0], 1.1, 1e-9);
}

TEST(DetectionScore, ScoresAdd) {
  DetectionScore one, other;
  one.add(drive(10), at({101}));
  other.add(drive(10), at({}));
  one += other;
  EXPECT_EQ(one.missed.of, 2U);
  EXPECT_EQ(one.missed.count, 1U);
  EXPECT_NEAR(one.right_s, 19.8, 1e-9);
}

TEST(DetectionScore, TheDualIndexRunsOverTheDrivesResiduals) {
  MonitoredDrive noisy = drive(10);
  for (std::size_t i = 0; i < noisy.scans.size(); ++i) {
    noisy.scans[i].matches = 1000;
    noisy.scans[i].mean_residual_m = i >= 100 ? 0.2 : i % 2 ? 0.01 : 0.03;
  }
  const Alarms alarms = alarms_by_dual_index(noisy, {});
  EXPECT_EQ(std::count(alarms.begin(), alarms.begin() + 100, true), 0);
  EXPECT_TRUE(alarms[100]);
}

}  // namespace
}  // namespace holdfast::benchmarks
