#include "holdfast/monitor/dual_index.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace holdfast::monitor {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

SE3 at(double x, double yaw_rad = 0) {
  return {so3::exp(Eigen::Vector3d(0, 0, yaw_rad)), {x, 0, 0}};
}

DualIndexInput scan(double residual_m, const SE3& T_map_body = {}) {
  return {T_map_body, T_map_body, residual_m, false};
}

/// Residuals of 0.01 and 0.03 m in turn: mean 0.02, standard deviation 0.01, threshold 0.04 m.
void drive_quietly(DualIndexDetector& detector, int scans = 50) {
  for (int i = 0; i < scans; ++i) EXPECT_FALSE(detector.judge(scan(i % 2 ? 0.03 : 0.01)).candidate);
}

TEST(DualIndex, TheThresholdIsMeanAndTwoStandardDeviationsOfTheLastFiftyScans) {
  DualIndexDetector detector({});
  for (int i = 0; i < 30; ++i) detector.judge(scan(0.02));  // to be forgotten
  for (int i = 0; i < 50; ++i) detector.judge(scan(i % 2 ? 0.03 : 0.01));
  EXPECT_NEAR(detector.judge(scan(0.02)).threshold_m, 0.04, 1e-12);
}

TEST(DualIndex, AScanAboveTheThresholdIsACandidateAndNoAnomaly) {
  DualIndexDetector detector({});
  drive_quietly(detector);
  const DualIndexVerdict verdict = detector.judge(scan(0.05));
  EXPECT_TRUE(verdict.candidate);
  EXPECT_FALSE(verdict.jumped);
  EXPECT_FALSE(verdict.anomaly);
}

TEST(DualIndex, OneScanAboveTwiceTheThresholdIsAnAnomaly) {
  DualIndexDetector detector({});
  drive_quietly(detector);
  EXPECT_FALSE(detector.judge(scan(0.079)).anomaly);
  detector.reset();
  drive_quietly(detector);
  EXPECT_TRUE(detector.judge(scan(0.081)).anomaly);
}

TEST(DualIndex, ThreeCandidatesWithJumpsOnEndAreAnAnomaly) {
  DualIndexDetector detector({});
  drive_quietly(detector);
  EXPECT_FALSE(detector.judge(scan(0.05, at(0.6))).anomaly);
  EXPECT_FALSE(detector.judge(scan(0.05, at(1.2))).anomaly);
  EXPECT_TRUE(detector.judge(scan(0.06, at(1.8))).anomaly);
}

TEST(DualIndex, AQuietScanBetweenStartsTheCountAnew) {
  DualIndexDetector detector({});
  drive_quietly(detector);
  double x = 0;
  for (const double residual_m : {0.05, 0.05, 0.02, 0.05, 0.05}) {
    EXPECT_FALSE(detector.judge(scan(residual_m, at(x += 0.6))).anomaly);
  }
}

TEST(DualIndex, CandidatesWithoutJumpsAreNone) {
  DualIndexDetector detector({});
  drive_quietly(detector);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(detector.judge(scan(0.05 + 0.005 * i)).anomaly);
}

TEST(DualIndex, JumpsOfTheRotationCountAsWell) {
  DualIndexDetector detector({});
  detector.judge(scan(0.02));
  EXPECT_FALSE(detector.judge(scan(0.02, at(0, 9.9 * kDegree))).jumped);
  EXPECT_TRUE(detector.judge(scan(0.02, at(0, 20.1 * kDegree))).jumped);
}

TEST(DualIndex, TooFewMatchesMakeACandidateWithoutAnyResidual) {
  DualIndexDetector detector({});
  drive_quietly(detector);
  for (int i = 1; i <= 3; ++i) {
    const DualIndexVerdict verdict = detector.judge({at(0.6 * i), at(0.6 * i), std::nullopt, true});
    EXPECT_TRUE(verdict.candidate);
    EXPECT_EQ(verdict.anomaly, i == 3);
  }
}

TEST(DualIndex, NothingIsUnusualBeforeThereIsAHistory) {
  DualIndexDetector detector({});
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(detector.judge(scan(i == 9 ? 5.0 : 0.01)).candidate);
}

TEST(DualIndex, TheFixedThresholdOfTable7NeedsNoHistory) {
  DualIndexConfig config;
  config.fixed_threshold_m = 0.15;
  DualIndexDetector detector(config);
  EXPECT_FALSE(detector.judge(scan(0.149)).candidate);
  EXPECT_TRUE(detector.judge(scan(0.151)).candidate);
  EXPECT_TRUE(detector.judge(scan(0.301)).anomaly);
}

/// 0.3 degrees a scan, 100 m from the origin of the map.
TEST(DualIndex, TheJumpAsPrintedHasALeverArmAboutTheOrigin) {
  for (const char* from : {"printed", "body"}) {
    DualIndexConfig config;
    config.jump_from = from;
    DualIndexDetector detector(config);
    detector.judge(scan(0.02, at(100)));
    const DualIndexVerdict verdict = detector.judge(scan(0.02, at(100, 0.3 * kDegree)));
    const double lever = 2 * 100 * std::sin(0.15 * kDegree);
    EXPECT_NEAR(verdict.jump_m, std::string(from) == "printed" ? lever : 0, 1e-9);
    EXPECT_EQ(verdict.jumped, std::string(from) == "printed");
  }
}

TEST(DualIndex, AgainstThePredictionSpeedIsNoJump) {
  DualIndexConfig config;
  config.jump_from = "prediction";
  DualIndexDetector detector(config);
  detector.judge(scan(0.02, at(0)));
  EXPECT_FALSE(detector.judge(scan(0.02, at(1.1))).jumped);  // 11 m/s, as predicted
  EXPECT_TRUE(detector.judge({at(2.8), at(2.2), 0.02, false}).jumped);
}

TEST(DualIndex, ForgetsEverythingAfterARelocalization) {
  DualIndexDetector detector({});
  drive_quietly(detector);
  detector.judge(scan(0.05, at(0.6)));
  detector.judge(scan(0.05, at(1.2)));
  detector.reset();
  const DualIndexVerdict verdict = detector.judge(scan(0.5, at(50)));
  EXPECT_FALSE(verdict.candidate);
  EXPECT_FALSE(verdict.jumped);
}

}  // namespace
}  // namespace holdfast::monitor
