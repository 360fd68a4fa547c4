#include "holdfast/monitor/health_monitor.hpp"

#include <gtest/gtest.h>

namespace holdfast::monitor {
namespace {

constexpr TimeNs kScan = kSecond / 10;
constexpr UsualLooks kCorridor{0.92, 0.015, 0.0, 15};
constexpr Looks kAsUsual{0.87, 0.92, 0.015, 0.0};
constexpr Looks kInACrowd{0.75, 0.45, 0.01, 0.08};
constexpr Looks kTurnedAround{0.64, 0.90, 0.08, 0.01};  // in the same corridor
constexpr Looks kElsewhere{0.4, 0.5, 0.25, 0.3};
constexpr Looks kOffTheMap{0.87, 0.0, 0.0, 1.0};

/// A robot at 1 m/s, a scan every 0.1 s.
class Drive {
 public:
  explicit Drive(bool map_tells_usual = true) : map_tells_usual_(map_tells_usual) {}

  Health scan(std::optional<Looks> looks, bool odometry_broke = false) {
    HealthInput input;
    input.t = t_ += kScan;
    input.way_m = 0.1;
    input.looks = looks;
    input.odometry_broke = odometry_broke;
    input.way_squared_distance = way_;
    if (map_tells_usual_) input.usual = kCorridor;
    return monitor_.judge(input);
  }

  /// From what was seen before to this, in 3 s, as crowds come and maps end.
  void drift_to(const Looks& from, const Looks& to) {
    for (int i = 0; i < 30; ++i) {
      const auto mix = [&](double a, double b) { return a + (b - a) * i / 30.0; };
      scan(Looks{mix(from.fitting, to.fitting), mix(from.paired, to.paired),
                 mix(from.through, to.through), mix(from.unmapped, to.unmapped)});
    }
  }

  Health drive(double seconds, std::optional<Looks> looks) {
    Health health;
    for (int i = 0; i < 10 * seconds; ++i) health = scan(looks);
    return health;
  }

  /// Seconds until the verdict is not healthy; 60: never.
  double seconds_to_alarm(const Looks& looks) {
    for (int i = 0; i < 600; ++i) {
      if (scan(looks).verdict != Verdict::kHealthy) return i / 10.0;
    }
    return 60;
  }

  std::optional<double> way_ = 1.0;

 private:
  HealthMonitor monitor_{MonitorConfig{}};
  TimeNs t_ = kSecond;
  bool map_tells_usual_;
};

TEST(HealthMonitor, AnHourOfDrivingAsUsualRaisesNoAlarm) {
  Drive drive;
  for (int i = 0; i < 36000; ++i) {
    ASSERT_EQ(drive.scan(kAsUsual).verdict, Verdict::kHealthy) << i / 10.0 << " s";
  }
  EXPECT_LT(drive.scan(kAsUsual).p_wrong, 1e-4);
}

TEST(HealthMonitor, AKidnapIsNoticedByTheThirdScan) {
  for (const Looks& there : {kElsewhere, kTurnedAround}) {
    Drive drive;
    drive.drive(20, kAsUsual);
    EXPECT_LE(drive.seconds_to_alarm(there), 0.2) << there.fitting;
  }
}

TEST(HealthMonitor, AKidnapThatTheOdometryFeltIsNoticedAtOnce) {
  Drive drive;
  drive.drive(20, kAsUsual);
  const Health health = drive.scan(kElsewhere, true);
  EXPECT_EQ(health.verdict, Verdict::kLost);
  EXPECT_TRUE(health.onset.odometry_broke);
}

TEST(HealthMonitor, AWrongStartInASimilarPlaceIsNoticedByTheMapsWordForWhatIsUsual) {
  EXPECT_LE(Drive().seconds_to_alarm(kElsewhere), 0.0);
  EXPECT_LE(Drive().seconds_to_alarm(kTurnedAround), 5.0);
}

TEST(HealthMonitor, ACrowdIsNoReasonForAnAlarm) {
  Drive drive;
  drive.drive(10, kAsUsual);
  drive.drift_to(kAsUsual, kInACrowd);
  EXPECT_EQ(drive.seconds_to_alarm(kInACrowd), 60);
  EXPECT_GT(drive.scan(kInACrowd).p_hidden, 0.9);
}

TEST(HealthMonitor, LeavingTheMapIsNoReasonForAnAlarm) {
  Drive drive;
  drive.drive(10, kAsUsual);
  drive.drift_to(kAsUsual, kOffTheMap);
  EXPECT_EQ(drive.seconds_to_alarm(kOffTheMap), 60);
  EXPECT_GT(drive.scan(kOffTheMap).p_outside, 0.9);
}

TEST(HealthMonitor, ARobotThatWasLostOffTheMapStaysLost) {
  Drive drive;
  drive.drive(10, kAsUsual);
  drive.drive(2, kElsewhere);
  EXPECT_EQ(drive.drive(30, kOffTheMap).verdict, Verdict::kLost);
}

TEST(HealthMonitor, FifteenSecondsWithoutScansAreNoReasonForAnAlarm) {
  Drive drive;
  drive.drive(10, kAsUsual);
  drive.way_.reset();
  EXPECT_EQ(drive.drive(15, std::nullopt).verdict, Verdict::kHealthy);
  EXPECT_EQ(drive.drive(1, kAsUsual).verdict, Verdict::kHealthy);
}

TEST(HealthMonitor, AWayThatTheOdometryDidNotGoIsNoticedWhereTheScanDoesNotFitAsUsual) {
  Drive drive;
  drive.drive(10, kAsUsual);
  constexpr Looks worse{0.75, 0.85, 0.03, 0.02};
  drive.drift_to(kAsUsual, worse);
  drive.drive(5, worse);
  drive.way_ = 200;
  EXPECT_LE(drive.seconds_to_alarm(worse), 3.0);
}

TEST(HealthMonitor, APoseThatIsRightAgainIsBelievedAfterSomeSecondsOfWay) {
  Drive drive;
  drive.drive(10, kAsUsual);
  ASSERT_EQ(drive.drive(2, kElsewhere).verdict, Verdict::kLost);
  EXPECT_EQ(drive.scan(kAsUsual).verdict, Verdict::kLost);
  EXPECT_EQ(drive.drive(10, kAsUsual).verdict, Verdict::kHealthy);
}

TEST(HealthMonitor, WithoutTheMapsWordTheRunTellsWhatIsUsual) {
  constexpr Looks poor{0.82, 0.5, 0.05, 0.02};
  Drive drive(false);
  EXPECT_EQ(drive.drive(60, poor).verdict, Verdict::kHealthy);
  EXPECT_NEAR(drive.scan(poor).usual->paired, poor.paired, 0.05);
  EXPECT_LE(drive.seconds_to_alarm(Looks{0.4, 0.2, 0.25, 0.3}), 0.2);
}

}  // namespace
}  // namespace holdfast::monitor
