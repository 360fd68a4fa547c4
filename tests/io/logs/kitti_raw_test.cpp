#include "holdfast/io/kitti_raw.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "holdfast/io/logs/kitti_files.hpp"
#include "tests/io/logs/log_content.hpp"
#include "tests/io/logs/message_builder.hpp"
#include "tests/io/temporary_folder.hpp"

namespace holdfast::io::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr TimeNs kNoon = 1317038400 * kSecond;  // 2011-09-26 12:00:00 UTC

/// Text of a time `ns` after noon.
std::string time_text(TimeNs ns) {
  return fmt::format("2011-09-26 12:00:{:02}.{:09}\n", ns / kSecond, ns % kSecond);
}

std::string binary(const std::vector<float>& values) {
  std::string bytes;
  for (const float v : values) files::append(bytes, v);
  return bytes;
}

/// A drive of three scans and four OXTS samples, 0.1 s apart.
struct KittiRaw : ::testing::Test {
  TemporaryFolder folder;
  std::string drive = "2011_09_26/2011_09_26_drive_0001_sync/";

  void SetUp() override {
    std::string starts, ends, imu_times;
    for (int i = 0; i < 3; ++i) {
      starts += time_text(i * kPeriod + 5);
      ends += time_text((i + 1) * kPeriod + 5);
      // Left, front, right of the car, and just beside the rear.
      put(fmt::format("velodyne_points/data/{:010}.bin", i),
          binary({0, 5, 1, 0.25F, 5, 0, 1, 0.5F, 0, -5, 1, 0.75F, -5, -1e-6F, 1, 1}));
    }
    for (int i = 0; i < 4; ++i) {
      imu_times += time_text(i * kPeriod);
      put(fmt::format("oxts/data/{:010}.txt", i), oxts_line(49.0 + i * 1e-5, 8.4, 110.0 + i));
    }
    put("velodyne_points/timestamps_start.txt", starts);
    put("velodyne_points/timestamps_end.txt", ends);
    put("oxts/timestamps.txt", imu_times);
    folder.put("2011_09_26/calib_imu_to_velo.txt",
               "calib_time: 25-May-2012 16:47:16\nR: 0 1 0 -1 0 0 0 0 1\nT: 1 2 3\n");
  }
  void put(const std::string& name, std::string_view content) { folder.put(drive + name, content); }
  static std::string oxts_line(double latitude, double longitude, double altitude) {
    return fmt::format(
        "{:.14f} {:.14f} {} 0.01 0.02 0.03 1 2 3 4 5 0.5 -0.25 9.75 6 7 8 0.125 -0.5 0.75 9 10 11 "
        "0.05 0.02 4 10 4 4 0\n",
        latitude, longitude, altitude);
  }
};

TEST_F(KittiRaw, ScansAndSamplesComeInTheOrderOfTheirEnds) {
  const auto log = read_log(folder.path());
  EXPECT_EQ(log.order, "iisisis");
  ASSERT_EQ(log.imu.size(), 4U);
  EXPECT_EQ(log.imu[1].t, kNoon + kPeriod);
  EXPECT_EQ(log.imu[0].accel_m_s2, Eigen::Vector3d(0.5, -0.25, 9.75));
  EXPECT_EQ(log.imu[0].gyro_rad_s, Eigen::Vector3d(0.125, -0.5, 0.75));
}

TEST_F(KittiRaw, ASweepTurnsClockwiseFromTheRear) {
  const auto log = read_log(folder.path());
  const Scan& scan = log.scans.at(0);
  EXPECT_EQ(scan.stamp, kNoon + 5);
  EXPECT_TRUE(scan.has_point_times);
  EXPECT_FALSE(scan.has_ring);
  ASSERT_EQ(scan.points.size(), 4U);
  EXPECT_EQ(scan.points[0].time_offset_ns, 25'000'000);  // left
  EXPECT_EQ(scan.points[1].time_offset_ns, 50'000'000);  // front
  EXPECT_EQ(scan.points[2].time_offset_ns, 75'000'000);  // right
  EXPECT_NEAR(scan.points[3].time_offset_ns, 100'000'000, 10);
  EXPECT_EQ(scan.points[2].intensity, 0.75F);
  EXPECT_EQ(scan.end_time, scan.stamp + scan.points[3].time_offset_ns);
  EXPECT_EQ(log.times.field, "azimuth");
}

TEST_F(KittiRaw, TextPointsAreReadAsBinaryOnesAre) {
  put("velodyne_points/data/0000000003.txt", "0 5 1 0.25\n5 0 1 0.5\n");
  put("velodyne_points/timestamps_start.txt",
      time_text(5) + time_text(kPeriod) + time_text(2 * kPeriod) + time_text(3 * kPeriod));
  put("velodyne_points/timestamps_end.txt", time_text(kPeriod) + time_text(2 * kPeriod) +
                                                time_text(3 * kPeriod) + time_text(4 * kPeriod));
  const auto log = read_log(folder.path());
  ASSERT_EQ(log.scans.size(), 4U);
  EXPECT_EQ(log.scans[3].points.size(), 2U);
  EXPECT_EQ(log.scans[3].points[1].x, 5);
}

TEST_F(KittiRaw, BadFilesAndPointsAreCountedAndSurvived) {
  put("velodyne_points/data/0000000001.bin", "not sixteen bytes");
  put("velodyne_points/data/0000000002.bin",
      binary({0, 0, 0, 0, std::nanf(""), 0, 0, 0, 1, 2, 3, 4}));
  put("oxts/data/0000000001.txt", "1 2 3\n");
  put("oxts/data/0000000002.txt", "nowhere\n");
  std::string infinite = oxts_line(49, 8.4, 110);
  infinite.replace(infinite.find("9.75"), 4, "inf");
  put("oxts/data/0000000003.txt", infinite);
  const auto log = read_log(folder.path());
  EXPECT_EQ(log.scans.size(), 2U);
  EXPECT_EQ(log.scans.at(1).points.size(), 1U);
  EXPECT_EQ(log.counters.invalid_points, 1U);
  EXPECT_EQ(log.counters.no_return_points, 1U);
  EXPECT_EQ(log.counters.bad_messages, 3U);
  EXPECT_EQ(log.counters.non_finite_imu, 1U);
}

TEST_F(KittiRaw, FramesThatWereNotRecordedAreLeftOut) {
  std::filesystem::remove(folder / (drive + "velodyne_points/data/0000000001.bin"));
  put("velodyne_points/timestamps_start.txt", time_text(5) + "\n" + time_text(2 * kPeriod));
  const auto log = read_log(folder.path());
  ASSERT_EQ(log.scans.size(), 2U);
  EXPECT_EQ(log.scans[1].stamp, kNoon + 2 * kPeriod);
}

TEST_F(KittiRaw, StampsThatJumpBackAreDroppedAndCounted) {
  put("oxts/timestamps.txt",
      time_text(0) + time_text(kPeriod) + time_text(kPeriod / 2) + time_text(3 * kPeriod));
  put("velodyne_points/timestamps_start.txt", time_text(5) + time_text(3) + time_text(2 * kPeriod));
  const auto log = read_log(folder.path());
  EXPECT_EQ(log.counters.imu_stamps_back, 1U);
  EXPECT_EQ(log.counters.scan_stamps_back, 1U);
  EXPECT_EQ(log.imu.size(), 3U);
  EXPECT_EQ(log.scans.size(), 2U);
}

TEST_F(KittiRaw, ASliceTakesItsScans) {
  LogOptions options;
  options.scan_start = 1;
  options.scan_stop = 2;
  const auto log = read_log(folder.path(), options);
  ASSERT_EQ(log.scans.size(), 1U);
  EXPECT_EQ(log.scans[0].stamp, kNoon + kPeriod + 5);
  EXPECT_EQ(log.imu.size(), 4U);
}

TEST_F(KittiRaw, WithoutOxtsThereIsALogOnlyIfNoImuIsNeeded) {
  std::filesystem::remove_all(folder / (drive + "oxts"));
  EXPECT_THAT(error_of_log(folder.path()), HasSubstr("oxts/timestamps.txt: cannot be opened"));
  LogOptions options;
  options.need_imu = false;
  EXPECT_EQ(read_log(folder.path(), options).order, "sss");
}

TEST_F(KittiRaw, ErrorsNameFileAndLine) {
  put("oxts/timestamps.txt", time_text(0) + "yesterday\n" + time_text(1) + time_text(2));
  EXPECT_THAT(error_of_log(folder.path()),
              HasSubstr("oxts/timestamps.txt: line 2: 'yesterday' is not a time"));
  put("oxts/timestamps.txt", time_text(0));
  EXPECT_THAT(error_of_log(folder.path()),
              HasSubstr("oxts/timestamps.txt: has 1 lines but there is a file 0000000001.txt"));
  put("velodyne_points/timestamps_end.txt", time_text(kPeriod) + time_text(1) + time_text(2));
  EXPECT_THAT(error_of_log(folder.path()),
              HasSubstr("timestamps_end.txt: line 2: expected a time"));
  std::filesystem::remove_all(folder / (drive + "velodyne_points/data"));
  EXPECT_THAT(error_of_log(folder.path()), HasSubstr("velodyne_points: has no scan"));
}

TEST_F(KittiRaw, AFolderMustHoldExactlyOneDrive) {
  std::filesystem::create_directories(folder / "2011_09_27/x_sync/velodyne_points");
  EXPECT_THAT(error_of_log(folder.path()), AllOf(HasSubstr("holds 2 KITTI raw drives"),
                                                 HasSubstr("0001_sync"), HasSubstr("x_sync")));
  EXPECT_THAT(error_of_log(folder / (drive + "oxts")), HasSubstr("is not a KITTI raw drive"));
  EXPECT_EQ(read_log(folder / drive).scans.size(), 3U);
}

TEST_F(KittiRaw, TimesAreReadAsUtcToTheNanosecond) {
  EXPECT_EQ(logs::parse_date_time("2011-09-26 12:00:00.000000001"), kNoon + 1);
  EXPECT_EQ(logs::parse_date_time("2011-09-26 12:00:00"), kNoon);
  EXPECT_EQ(logs::parse_date_time("2012-02-29 00:00:00.5"), 1330473600 * kSecond + kSecond / 2);
  EXPECT_EQ(logs::parse_date_time("1970-01-01 00:00:00.0"), 0);
  for (const char* bad : {"", "2011-09-26", "2011-02-29 12:00:00", "2011-09-26T12:00:00",
                          "2011-09-26 24:00:00", "2011-09-26 12:0a:00", "2011-09-26 12:00:00,5"}) {
    EXPECT_FALSE(logs::parse_date_time(bad)) << bad;
  }
}

TEST_F(KittiRaw, TruthIsEastNorthUpFromTheFirstPose) {
  const auto poses = read_kitti_truth(folder.path());
  ASSERT_TRUE(poses) << poses.error().message;
  ASSERT_EQ(poses->size(), 4U);
  EXPECT_TRUE((*poses)[0].T_map_body.translation.isZero(0));
  // 1e-5 degrees of latitude on a sphere of the equator's radius; Mercator's scale changes by
  // tan(49 degrees) * 3e-5 degrees, less than 1e-6, over three of them.
  const Eigen::Vector3d north(0, 3e-5 * M_PI / 180 * 6378137.0, 3);
  EXPECT_LE(((*poses)[3].T_map_body.translation - north).norm(), 4e-6);
  EXPECT_EQ((*poses)[3].t, kNoon + 3 * kPeriod);
  const Eigen::Vector3d forward = (*poses)[0].T_map_body.rotation * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(std::atan2(forward.y(), forward.x()), 0.03, 1e-12);  // yaw from east
  EXPECT_NEAR(forward.z(), -std::sin(0.02), 1e-12);                // pitch: front down
  const Eigen::Vector3d left = (*poses)[0].T_map_body.rotation * Eigen::Vector3d::UnitY();
  EXPECT_NEAR(left.z(), std::sin(0.01) * std::cos(0.02), 1e-12);  // roll: left side up
}

TEST_F(KittiRaw, TruthThatIsNoPoseIsAnError) {
  std::string line = oxts_line(49, 8.4, 110);
  put("oxts/data/0000000002.txt", "nan" + line.substr(line.find(' ')));
  const auto poses = read_kitti_truth(folder.path());
  ASSERT_FALSE(poses);
  EXPECT_THAT(poses.error().message, HasSubstr("0000000002.txt: does not hold a pose"));
}

TEST_F(KittiRaw, ExtrinsicsAreTheInverseOfTheCalibration) {
  const auto T_body_lidar = read_kitti_extrinsics(folder / drive);
  ASSERT_TRUE(T_body_lidar) << T_body_lidar.error().message;
  // p_lidar = R p_body + T, with R a quarter turn.
  const Eigen::Vector3d p_body(4, 5, 6);
  const Eigen::Vector3d p_lidar(5 + 1, -4 + 2, 6 + 3);
  EXPECT_LE((*T_body_lidar * p_lidar - p_body).norm(), 1e-14);
}

TEST_F(KittiRaw, ACalibrationThatIsNoneIsAnError) {
  const auto error_with = [this](std::string_view text) {
    folder.put("2011_09_26/calib_imu_to_velo.txt", text);
    const auto result = read_kitti_extrinsics(folder.path());
    EXPECT_FALSE(result);
    return result ? "" : result.error().message;
  };
  EXPECT_THAT(error_with("T: 1 2 3\n"), HasSubstr("has no line 'R:'"));
  EXPECT_THAT(error_with("R: 1 0 0 0 1 0 0 0\nT: 1 2 3\n"),
              HasSubstr("R: has 8 values, expected 9"));
  EXPECT_THAT(error_with("R: 1 0 0 0 1 0 0 0 2\nT: 1 2 3\n"), HasSubstr("not a rotation matrix"));
  EXPECT_THAT(error_with("R: 1 0 0 0 1 0 0 0 -1\nT: 1 2 3\n"), HasSubstr("not a rotation matrix"));
  EXPECT_THAT(error_with("R: 1 0 0 0 1 0 0 0 1\nT: 1 2 x\n"), HasSubstr("T: 'x'"));
  std::filesystem::remove(folder / "2011_09_26/calib_imu_to_velo.txt");
  EXPECT_THAT(read_kitti_extrinsics(folder.path()).error().message,
              HasSubstr("calib_imu_to_velo.txt: cannot be opened"));
}

}  // namespace
}  // namespace holdfast::io::testing
