#include "holdfast/pipeline/accumulate.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace holdfast::pipeline {
namespace {

using Eigen::Vector3d;

constexpr TimeNs kStart = 1'700'000'000 * kSecond;
constexpr TimeNs kRevolution = kSecond / 10;

/// Scans, one after the other.
class Scans : public SensorSource {
 public:
  explicit Scans(std::vector<Scan> scans) : scans_(std::move(scans)) {}
  Result<std::optional<SensorEvent>> next() override {
    if (imu_next_) {
      imu_next_ = false;
      return std::optional<SensorEvent>(ImuSample{});
    }
    imu_next_ = true;
    if (at_ == scans_.size()) {
      if (fail_at_end) return Error{"the log is broken"};
      return std::optional<SensorEvent>();
    }
    return std::optional<SensorEvent>(scans_[at_++]);
  }
  double progress() const override {
    return static_cast<double>(at_) / static_cast<double>(scans_.size());
  }
  bool fail_at_end = false;

 private:
  std::vector<Scan> scans_;
  std::size_t at_ = 0;
  bool imu_next_ = true;
};

SE3 extrinsic() { return {so3::exp({0.05, -0.02, 0.8}), {0.4, -0.2, 0.9}}; }

/// A drive around a bend at 5 m/s and 0.6 rad/s.
SE3 truth(double s) {
  const double w = 0.6;
  const double r = 5.0 / w;
  return {so3::exp({0, 0, w * s}), {r * std::sin(w * s), r * (1 - std::cos(w * s)), 0.5}};
}

std::vector<StampedPose> poses(double from_s, double to_s, double step_s = 0.01) {
  std::vector<StampedPose> result;
  for (double s = from_s; s <= to_s + 1e-9; s += step_s) {
    result.push_back({kStart + from_seconds(s), truth(s)});
  }
  return result;
}

/// Landmarks each 0.5 m on a circle around the start.
std::vector<Vector3d> landmarks() {
  std::vector<Vector3d> result;
  for (int k = 0; k < 200; ++k) {
    const double a = 2 * M_PI * k / 200;
    result.emplace_back(16 * std::cos(a) + 0.017, 16 * std::sin(a) + 0.023, 0.013 + 0.0107 * k);
  }
  return result;
}

/// The landmarks as the LiDAR sees them from scan `number`, each at its own time.
Scan scan_of_landmarks(int number) {
  Scan scan;
  scan.stamp = kStart + number * kRevolution;
  scan.end_time = scan.stamp + kRevolution;
  scan.has_point_times = true;
  const auto marks = landmarks();
  for (std::size_t k = 0; k < marks.size(); ++k) {
    const auto offset = static_cast<std::int32_t>(kRevolution * static_cast<TimeNs>(k) /
                                                  static_cast<TimeNs>(marks.size() - 1));
    const SE3 T_map_lidar = truth(to_seconds(scan.stamp + offset - kStart)) * extrinsic();
    const Eigen::Vector3f p = (T_map_lidar.inverse() * marks[k]).cast<float>();
    scan.points.push_back({p.x(), p.y(), p.z(), 0, offset, 0});
  }
  return scan;
}

preprocess::ScanSelectionConfig everything() {
  preprocess::ScanSelectionConfig config;
  config.min_range_m = 0.1;
  return config;
}

struct Placed {
  Accumulated counts;
  io::PointCloud cloud;
};

Placed accumulated(std::vector<Scan> scans, const std::vector<StampedPose>& T_map_body,
                   const preprocess::ScanSelectionConfig& selection = everything()) {
  Placed run;
  Scans log(std::move(scans));
  const auto result = accumulate(log, T_map_body, extrinsic(), selection, run.cloud);
  EXPECT_TRUE(result) << result.error().message;
  if (result) run.counts = *result;
  return run;
}

/// Largest distance of a point of the cloud to the nearest landmark.
double worst(const io::PointCloud& cloud) {
  double most = 0;
  for (const auto& p : cloud.points) {
    double least = 1e9;
    for (const auto& mark : landmarks()) {
      least = std::min(least, (p.cast<double>() + cloud.origin - mark).norm());
    }
    most = std::max(most, least);
  }
  return most;
}

// Poses 0.01 s apart, straight between them: a dt^2 / 8 with a = v w = 3 m/s^2 in position and the
// same of the landmarks' distance of 25 m at 0.6^2 rad^2/s^2; floats of 25 m.
constexpr double kPlaced = (3.0 + 25 * 0.36) * 0.01 * 0.01 / 8 * 2 + 1e-5;

TEST(Accumulate, PutsEveryPointWhereItsOwnTimeSaysItIs) {
  const Placed run =
      accumulated({scan_of_landmarks(0), scan_of_landmarks(1), scan_of_landmarks(2)}, poses(0, 1));
  EXPECT_EQ(run.counts.scans, 3U);
  EXPECT_EQ(run.counts.outside, 0U);
  EXPECT_GE(run.cloud.points.size(), landmarks().size());
  EXPECT_LT(worst(run.cloud), kPlaced);
}

TEST(Accumulate, KeepsOnePointOfEachCellOfFiveCentimetres) {
  Scan scan = scan_of_landmarks(0);
  const Placed once = accumulated({scan}, poses(0, 1));
  scan.points.insert(scan.points.end(), scan.points.begin(), scan.points.end());
  const Placed twice = accumulated({scan}, poses(0, 1));
  EXPECT_EQ(once.cloud.points.size(), landmarks().size());
  EXPECT_EQ(twice.cloud.points, once.cloud.points);
}

TEST(Accumulate, ScansNotWhollyInsideOfThePosesAreLeftOutAndCounted) {
  const Placed run = accumulated(
      {scan_of_landmarks(0), scan_of_landmarks(3), scan_of_landmarks(6), scan_of_landmarks(9)},
      poses(0.05, 0.95));
  EXPECT_EQ(run.counts.scans, 2U);
  EXPECT_EQ(run.counts.outside, 2U);
}

TEST(Accumulate, ALongGapInThePosesIsNotBridged) {
  auto T_map_body = poses(0, 0.3);
  const auto later = poses(0.9, 1.3);
  T_map_body.insert(T_map_body.end(), later.begin(), later.end());
  const Placed run =
      accumulated({scan_of_landmarks(1), scan_of_landmarks(5), scan_of_landmarks(10)}, T_map_body);
  EXPECT_EQ(run.counts.scans, 2U);
  EXPECT_EQ(run.counts.outside, 1U);
  EXPECT_LT(worst(run.cloud), kPlaced);
}

TEST(Accumulate, WithoutPosesEveryScanIsOutside) {
  const Placed run = accumulated({scan_of_landmarks(0), scan_of_landmarks(1)}, {});
  EXPECT_EQ(run.counts.scans, 0U);
  EXPECT_EQ(run.counts.outside, 2U);
  EXPECT_TRUE(run.cloud.points.empty());
}

TEST(Accumulate, ATeleportIsNotInterpolatedAcross) {
  // Two poses with one stamp: the body stands elsewhere from then on. Scans before and after are
  // placed by their own side.
  auto T_map_body = poses(0, 0.2);
  for (const StampedPose& pose : poses(0.2, 0.4)) {
    T_map_body.push_back({pose.t, SE3{so3::exp({0, 0, 1.0}), {100, 0, 0}} * pose.T_map_body});
  }
  const Placed before = accumulated({scan_of_landmarks(0)}, T_map_body);
  EXPECT_EQ(before.counts.scans, 1U);
  EXPECT_LT(worst(before.cloud), kPlaced);
}

TEST(Accumulate, LimitsOfRangeApply) {
  preprocess::ScanSelectionConfig selection;
  selection.min_range_m = 15.8;
  selection.max_range_m = 16.2;
  const Scan scan = scan_of_landmarks(0);
  const Placed run = accumulated({scan}, poses(0, 1), selection);
  std::size_t expected = 0;
  for (const ScanPoint& p : scan.points) {
    const double range = Vector3d(p.x, p.y, p.z).norm();
    expected += range >= 15.8 && range <= 16.2 ? 1 : 0;
  }
  EXPECT_GT(expected, 0U);
  EXPECT_LT(expected, scan.points.size());
  EXPECT_EQ(run.cloud.points.size(), expected);
}

TEST(Accumulate, AScanWithoutPointTimesIsPlacedAtItsStamp) {
  Scan scan = scan_of_landmarks(0);
  scan.has_point_times = false;
  scan.end_time = scan.stamp;
  const SE3 T_map_lidar = truth(0) * extrinsic();
  const auto marks = landmarks();
  for (std::size_t k = 0; k < marks.size(); ++k) {
    const Eigen::Vector3f p = (T_map_lidar.inverse() * marks[k]).cast<float>();
    scan.points[k] = {p.x(), p.y(), p.z(), 0, 0, 0};
  }
  const Placed run = accumulated({scan}, poses(0, 1));
  EXPECT_EQ(run.counts.scans, 1U);
  EXPECT_LT(worst(run.cloud), kPlaced);
}

TEST(Accumulate, FarPosesGiveTheCloudAnOriginThatKeepsMillimetres) {
  const Vector3d far(456'789.0, 5'987'654.0, 310.0);
  auto T_map_body = poses(0, 1);
  for (StampedPose& pose : T_map_body) pose.T_map_body.translation += far;
  Placed run = accumulated({scan_of_landmarks(0), scan_of_landmarks(5)}, T_map_body);
  EXPECT_LT((run.cloud.origin - far).norm(), 100.0);
  run.cloud.origin -= far;
  EXPECT_GE(run.cloud.points.size(), landmarks().size());
  EXPECT_LT(worst(run.cloud), kPlaced);
}

TEST(Accumulate, FarNegativePosesKeepTheirPoints) {
  const Vector3d far(-456'789.0, -5'987'654.0, -310.0);
  auto T_map_body = poses(0, 1);
  for (StampedPose& pose : T_map_body) pose.T_map_body.translation += far;
  Placed run = accumulated({scan_of_landmarks(0)}, T_map_body);
  EXPECT_EQ(run.cloud.points.size(), landmarks().size());
}

TEST(Accumulate, ASecondLogAddsToTheCloudOfTheFirst) {
  io::PointCloud cloud;
  Scans first({scan_of_landmarks(0)});
  Scans second({scan_of_landmarks(0)});
  ASSERT_TRUE(accumulate(first, poses(0, 1), extrinsic(), everything(), cloud));
  const std::size_t points = cloud.points.size();
  ASSERT_TRUE(accumulate(second, poses(0, 1), extrinsic(), everything(), cloud));
  EXPECT_EQ(cloud.points.size(), points);  // the same cells
}

TEST(Accumulate, AnErrorOfTheLogIsHandedOn) {
  Scans log({scan_of_landmarks(0)});
  log.fail_at_end = true;
  io::PointCloud cloud;
  const auto result = accumulate(log, poses(0, 1), extrinsic(), everything(), cloud);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message, "the log is broken");
}

TEST(Accumulate, ProgressIsThatOfTheLog) {
  Scans log({scan_of_landmarks(0), scan_of_landmarks(1)});
  io::PointCloud cloud;
  std::vector<double> told;
  ASSERT_TRUE(accumulate(log, poses(0, 1), extrinsic(), everything(), cloud,
                         [&](double share) { told.push_back(share); }));
  EXPECT_EQ(told, (std::vector<double>{0.5, 1.0}));
}

}  // namespace
}  // namespace holdfast::pipeline
