#include <gtest/gtest.h>

#include <algorithm>

#include "holdfast/io/cloud_file.hpp"
#include "holdfast/io/kitti_raw.hpp"
#include "holdfast/io/tum_file.hpp"
#include "tests/io/logs/log_content.hpp"
#include "tests/io/temporary_folder.hpp"

namespace holdfast::io::testing {
namespace {

/// Public recordings and maps; skipped where they are not installed.
struct RealData : ::testing::Test {
  std::filesystem::path data = data_folder();

  void SetUp() override {
    if (!std::filesystem::exists(data / "kitti_0009")) GTEST_SKIP() << "no recordings in " << data;
  }
  void expect_cloud(const char* name, std::size_t points, bool has_intensity) {
    const auto cloud = read_cloud(data / name);
    ASSERT_TRUE(cloud) << cloud.error().message;
    EXPECT_EQ(cloud->points.size() + cloud->invalid_points, points);
    EXPECT_EQ(cloud->intensity.size(), has_intensity ? cloud->points.size() : 0);
    EXPECT_TRUE(cloud->origin.isZero(0));
  }
};

TEST_F(RealData, EveryMapIsReadWithAllItsPoints) {
  expect_cloud("utd_campus_west/map.pcd", 2881812, false);
  expect_cloud("small_maps/hdl_indoor.pcd", 101080, true);
  expect_cloud("small_maps/surf.pcd", 91531, true);
  expect_cloud("small_maps/corner.pcd", 63381, true);
}

TEST_F(RealData, TheDriveOfKitti9IsReadAsItWasRecorded) {
  const auto log = read_log(data / "kitti_0009/run.bag");
  ASSERT_EQ(log.scans.size(), 51U);
  ASSERT_EQ(log.imu.size(), 579U);
  EXPECT_EQ(log.times.field, "time");
  EXPECT_EQ(log.times.unit, "s");
  EXPECT_FALSE(log.times.absolute);
  EXPECT_EQ(log.counters.bad_messages + log.counters.invalid_points +
                log.counters.scan_stamps_back + log.counters.imu_stamps_back,
            0U);
  for (std::size_t i = 1; i < log.imu.size(); ++i) {
    EXPECT_NEAR(to_seconds(log.imu[i].t - log.imu[i - 1].t), 0.01, 0.001);
  }
  for (const auto& scan : log.scans) {
    EXPECT_TRUE(scan.has_point_times);
    EXPECT_FALSE(scan.has_ring);
    EXPECT_GT(scan.points.size(), 100'000U);
    const bool in_time_order = std::is_sorted(
        scan.points.begin(), scan.points.end(),
        [](const auto& a, const auto& b) { return a.time_offset_ns < b.time_offset_ns; });
    EXPECT_FALSE(in_time_order);  // laser after laser
  }
  for (std::size_t i = 1; i < log.scans.size(); ++i) {  // the sensor turns on and on
    EXPECT_NEAR(to_seconds(log.scans[i].stamp - log.scans[i - 1].end_time), 0, 1e-4);
  }
  EXPECT_EQ(log.scans[0].stamp, 1317042504905593633);  // header.stamp, the start of the sweep
}

TEST_F(RealData, TheTruthOfKitti9CoversItsScans) {
  const auto truth = read_tum(data / "kitti_0009/truth.tum");
  ASSERT_TRUE(truth) << truth.error().message;
  const auto log = read_log(data / "kitti_0009/run.bag");
  ASSERT_FALSE(truth->empty());
  EXPECT_LE(truth->front().t, log.scans.front().stamp);
  EXPECT_GE(truth->back().t, log.scans.back().end_time);
}

TEST_F(RealData, ACutDriveIsReadToTheCut) {
  TemporaryFolder folder;
  std::string bytes = read_bytes(data / "kitti_0009/run.bag");
  bytes.resize(bytes.size() / 8);
  const auto log = read_log(folder.put("cut.bag", bytes));
  EXPECT_TRUE(log.counters.truncated);
  EXPECT_GE(log.scans.size(), 5U);
  EXPECT_LE(log.scans.size(), 7U);
}

TEST_F(RealData, TheDriveOfKitti2IsReadFromItsFolder) {
  const auto log = read_log(data / "kitti_0002");
  ASSERT_EQ(log.scans.size(), 10U);
  ASSERT_EQ(log.imu.size(), 10U);
  EXPECT_EQ(log.scans[0].points.size(), 121080U);
  EXPECT_EQ(log.scans[0].stamp, 1317042164265816674);
  EXPECT_NEAR(log.imu[0].accel_m_s2.norm(), 9.81, 1.0);
  for (const auto& scan : log.scans) {
    EXPECT_NEAR(to_seconds(scan.end_time - scan.stamp), 0.1032, 0.0003);
  }
  const auto truth = read_kitti_truth(data / "kitti_0002");
  ASSERT_TRUE(truth) << truth.error().message;
  ASSERT_EQ(truth->size(), 10U);
  // 0.9 s at 8.6 m/s or a little more, the speed that the receiver gives beside the positions.
  EXPECT_NEAR(truth->back().T_map_body.translation.norm(), 0.95 * 8.7, 1.0);
  // The car drives where it looks.
  const Eigen::Vector3d along = truth->front().T_map_body.rotation.conjugate() *
                                truth->back().T_map_body.translation.normalized();
  EXPECT_GT(along.x(), 0.99);
}

TEST_F(RealData, TheExtrinsicsOfBothDrivesAgree) {
  const auto T_body_lidar = read_kitti_extrinsics(data / "kitti_0002");
  ASSERT_TRUE(T_body_lidar) << T_body_lidar.error().message;
  std::ifstream file(data / "kitti_0009/extrinsics.txt");
  std::string comment;
  std::getline(file, comment);
  double v[7];
  for (double& value : v) file >> value;
  ASSERT_TRUE(file);
  // The calibration has seven digits, and its matrix is a rotation to 1e-6.
  EXPECT_LE((T_body_lidar->translation - Eigen::Vector3d(v[0], v[1], v[2])).norm(), 2e-6);
  EXPECT_LE(so3::angle_between(T_body_lidar->rotation, Eigen::Quaterniond(v[6], v[3], v[4], v[5])),
            2e-6);
}

}  // namespace
}  // namespace holdfast::io::testing
