#include "benchmarks/yardsticks/kd_tree_registration.hpp"

#include <gtest/gtest.h>

#include "benchmarks/drives/closed_room.hpp"
#include "holdfast/core/random.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr double kSpacingM = 0.08;
/// Farther from any edge than a start is off, and than five neighbours reach: every fit is one
/// side.
constexpr double kMarginM = 0.6;

const SE3 kTruth{so3::exp({0.02, -0.03, 0.5}), {1.2, -0.7, -0.4}};

SE3 off_by(const Eigen::Vector3d& metres, const Eigen::Vector3d& radians) {
  return {kTruth.rotation * so3::exp(radians), kTruth.translation + metres};
}

registration::BodyPoints scan() { return ClosedRoom{}.scan(kTruth, 16, 200, kMarginM); }

Registration align(const registration::BodyPoints& points, const RegistrationStart& start,
                   const KdTreeOptions& options = {}) {
  KdTreeRegistration tree(ClosedRoom{}.surface(kSpacingM), options);
  return tree.align(points, Eigen::Vector3d::Zero(), start);
}

void expect_at_truth(const SE3& pose, double metres, double radians) {
  EXPECT_LT((pose.translation - kTruth.translation).norm(), metres);
  EXPECT_LT(so3::angle_between(pose.rotation, kTruth.rotation), radians);
}

TEST(ClosedRoomScan, LiesOnTheSides) {
  const ClosedRoom room;
  const auto points = scan();
  ASSERT_GT(points.size(), 1000U);
  for (const auto& q : points.points) {
    const Eigen::Vector3d p = kTruth * q.cast<double>();
    const double off = (room.half_size - p.cwiseAbs()).cwiseAbs().minCoeff();
    EXPECT_LT(off, 1e-5);  // float at 10 m
  }
}

TEST(KdTreeRegistration, FindsThePoseInARoomFromAnOffsetStart) {
  const KdTreeOptions options;
  RandomStream random(1, "kd_tree.starts");
  const auto points = scan();
  for (int i = 0; i < 10; ++i) {
    const auto axis = [&] {
      return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    };
    const Registration found = align(points, {off_by(0.1 * axis(), 0.01 * axis())});
    // It stops when a step is below these, and Gauss-Newton's last step is longer than what is
    // left.
    expect_at_truth(found.T_map_body, options.converged_m, options.converged_rad);
    EXPECT_GE(found.searches, 2);
    EXPECT_LE(found.iterations, options.max_iterations);
    EXPECT_EQ(found.pairs, static_cast<double>(points.size()));
  }
}

TEST(KdTreeRegistration, SearchesOnceWhereThePredictionIsGood) {
  const Registration found = align(scan(), {off_by({0.005, 0, 0}, {0, 0, 0.0005})});
  expect_at_truth(found.T_map_body, 1e-4, 1e-5);
  EXPECT_EQ(found.searches, 1);
}

TEST(KdTreeRegistration, WeighsThePredictionAgainstTheScan) {
  const auto points = scan();
  const SE3 start = off_by({0.05, 0, 0}, {0, 0, 0});
  const Registration firm = align(points, {start, 1e14 * Matrix6d::Identity()});
  EXPECT_LT((firm.T_map_body.translation - start.translation).norm(), 1e-4);
  const Registration loose = align(points, {start, 1e-3 * Matrix6d::Identity()});
  expect_at_truth(loose.T_map_body, 1e-4, 1e-5);
}

TEST(KdTreeRegistration, StaysAtThePredictionWhereTheMapHasNothing) {
  const SE3 start = off_by({40, 0, 0}, {0, 0, 0});
  const Registration found = align(scan(), {start, Matrix6d::Identity()});
  EXPECT_EQ(found.pairs, 0);
  EXPECT_LT((found.T_map_body.translation - start.translation).norm(), 1e-9);
}

TEST(KdTreeRegistration, LeavesOutPointsBeyondTheGate) {
  auto points = scan();
  const auto all = static_cast<double>(points.size());
  // Someone in front of the walls: each fourth point comes back from halfway.
  std::size_t early = 0;
  for (std::size_t i = 0; i < points.size(); i += 4, ++early) points.points[i] *= 0.5F;
  const Registration found = align(points, {kTruth});
  EXPECT_EQ(found.pairs, all - static_cast<double>(early));
  expect_at_truth(found.T_map_body, 1e-4, 1e-5);
}

}  // namespace
}  // namespace holdfast::benchmarks
