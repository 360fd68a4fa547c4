#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/io/logs/log_content.hpp"
#include "tests/io/logs/message_builder.hpp"
#include "tests/io/temporary_folder.hpp"

namespace holdfast::io::testing {
namespace {

using ::testing::ElementsAre;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct BagLog : ::testing::Test {
  TemporaryFolder folder;
  BagBytes bag{folder / "log.bag"};

  void add_imu(TimeNs t = kStart) { bag.add(imu_at(t)); }
  LogContent content(const LogOptions& options = {}) { return read_log(bag.finish(), options); }
};

TEST_F(BagLog, EventsComeInTheOrderOfTheirRecordTimes) {
  bag.add(plain_cloud(kStart, {{1, 2, 3}}));  // recorded at its end
  for (int i = 0; i < 5; ++i) add_imu(kStart + i * kSecond / 30);
  const auto log = content();
  EXPECT_EQ(log.order, "iiisii" + std::string());
  EXPECT_EQ(log.counters.imu_samples, 5U);
  EXPECT_EQ(log.counters.scans, 1U);
  EXPECT_EQ(log.counters.points, 1U);
}

TEST_F(BagLog, AnImuSampleKeepsEveryBit) {
  ImuSample sample{kStart + 123456789, {0.1, -1e-300, 3}, {1e300, -0.0, 9.80665}};
  bag.add(sample);
  bag.add(plain_cloud(kStart, {{1, 2, 3}}));
  const auto log = content();
  ASSERT_EQ(log.imu.size(), 1U);
  EXPECT_EQ(log.imu[0].t, sample.t);
  EXPECT_EQ(log.imu[0].gyro_rad_s, sample.gyro_rad_s);
  EXPECT_EQ(log.imu[0].accel_m_s2, sample.accel_m_s2);
}

TEST_F(BagLog, NonFinitePointsAreDroppedAndCounted) {
  add_imu();
  bag.add(plain_cloud(kStart,
                      {{1, 2, 3}, {kNan, 0, 0}, {4, kInfinity, 0}, {0, 0, -kInfinity}, {5, 6, 7}}));
  const auto log = content();
  ASSERT_EQ(log.scans.size(), 1U);
  EXPECT_EQ(log.scans[0].points.size(), 2U);
  EXPECT_EQ(log.scans[0].points[1].z, 7);
  EXPECT_EQ(log.scans[0].invalid_points, 3U);
  EXPECT_EQ(log.counters.invalid_points, 3U);
  EXPECT_EQ(log.counters.points, 2U);
}

TEST_F(BagLog, PointsAtTheOriginAreNoReturnsAndCounted) {
  add_imu();
  bag.add(plain_cloud(kStart, {{0, 0, 0}, {1, 0, 0}, {-0.0F, 0, -0.0F}, {0, 0, 1e-30F}}));
  const auto log = content();
  EXPECT_EQ(log.scans.at(0).points.size(), 2U);
  EXPECT_EQ(log.counters.no_return_points, 2U);
  EXPECT_EQ(log.counters.invalid_points, 0U);
}

TEST_F(BagLog, BadPointsAreDroppedInEveryBlockAndTheOrderIsKept) {
  add_imu();
  std::vector<Eigen::Vector3f> points;
  for (int i = 1; i <= 2000; ++i) {
    const auto x = static_cast<float>(i);
    points.emplace_back(i % 7 == 0 ? kNan : x, i % 11 == 0 ? 0.0F : 1.0F, 2.0F);
    if (i % 500 == 0) points.emplace_back(0, 0, 0);
  }
  bag.add(plain_cloud(kStart, points));
  const auto log = content();
  ASSERT_EQ(log.scans.size(), 1U);
  std::vector<float> expected;
  for (int i = 1; i <= 2000; ++i) {
    if (i % 7 != 0) expected.push_back(static_cast<float>(i));
  }
  ASSERT_EQ(log.scans[0].points.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(log.scans[0].points[i].x, expected[i]);
  }
  EXPECT_EQ(log.counters.invalid_points, 285U);
  EXPECT_EQ(log.counters.no_return_points, 4U);
}

TEST_F(BagLog, AnEmptyScanIsAnEventThatEndsAfterTheNominalPeriod) {
  add_imu();
  bag.add(plain_cloud(kStart, {}));  // the period is not known yet: 0.1 s
  TimeNs stamp = kStart;
  for (const TimeNs step : {50, 51, 49, 250, 50}) {
    stamp += step * 1'000'000;
    bag.add(plain_cloud(stamp, {{1, 2, 3}}));
  }
  bag.add(plain_cloud(stamp + kSecond / 20, {}));
  bag.add(plain_cloud(stamp + kSecond / 10, {{kNan, 0, 0}}));
  const auto log = content();
  ASSERT_EQ(log.scans.size(), 8U);
  EXPECT_TRUE(log.scans[0].points.empty());
  EXPECT_EQ(log.scans[0].end_time, kStart + kSecond / 10);
  EXPECT_EQ(log.scans[6].end_time - log.scans[6].stamp, kSecond / 20);  // the median
  EXPECT_EQ(log.scans[7].end_time - log.scans[7].stamp, kSecond / 20);
  EXPECT_EQ(log.counters.empty_scans, 3U);
  EXPECT_EQ(log.counters.scans, 8U);
}

TEST_F(BagLog, AScanWithoutTimesEndsAtItsStamp) {
  add_imu();
  bag.add(plain_cloud(kStart, {{1, 2, 3}}));
  const auto log = content();
  EXPECT_FALSE(log.scans.at(0).has_point_times);
  EXPECT_FALSE(log.scans[0].has_ring);
  EXPECT_EQ(log.scans[0].stamp, kStart);
  EXPECT_EQ(log.scans[0].end_time, kStart);
  EXPECT_TRUE(log.times.field.empty());
}

TEST_F(BagLog, NonFiniteImuSamplesAreDroppedAndCounted) {
  for (int i = 0; i < 4; ++i) {
    auto sample = imu_at(kStart + i);
    if (i == 1) sample.gyro_rad_s.y() = std::nan("");
    if (i == 2) sample.accel_m_s2.z() = HUGE_VAL;
    bag.add(sample);
  }
  bag.add(plain_cloud(kStart, {{1, 2, 3}}));
  const auto log = content();
  EXPECT_EQ(log.imu.size(), 2U);
  EXPECT_EQ(log.counters.non_finite_imu, 2U);
  EXPECT_EQ(log.counters.imu_samples, 2U);
}

TEST_F(BagLog, StampsThatJumpBackAreDroppedAndCounted) {
  const TimeNs imu_stamps[] = {0, 10, 5, 10, 11};
  for (const TimeNs t : imu_stamps) {
    bag.add(1, kStart, ros::serialise_imu(imu_at(kStart + t), 0, "imu"));
  }
  const TimeNs scan_stamps[] = {0, kPeriod, kPeriod, -kPeriod, 2 * kPeriod};
  TimeNs recorded = kStart;
  for (const TimeNs t : scan_stamps) {
    bag.add(0, ++recorded, plain_cloud(kStart + t, {{1, 2, 3}}).serialised());
  }
  const auto log = content();
  EXPECT_EQ(log.imu.size(), 3U);
  EXPECT_EQ(log.counters.imu_stamps_back, 2U);
  ASSERT_EQ(log.scans.size(), 3U);
  EXPECT_EQ(log.scans[2].stamp, kStart + 2 * kPeriod);
  EXPECT_EQ(log.counters.scan_stamps_back, 2U);
}

TEST_F(BagLog, ALoneStampFarAheadDoesNotMakeAllOthersLookOld) {
  for (const TimeNs t : {1000 * kSecond, TimeNs{1}, TimeNs{2}, 3000 * kSecond, TimeNs{3}}) {
    bag.add(1, kStart, ros::serialise_imu(imu_at(kStart + t), 0, "imu"));
  }
  for (const TimeNs t : {TimeNs{0}, 500 * kSecond, kPeriod, 2 * kPeriod}) {
    bag.add(0, kStart + 1, plain_cloud(kStart + t, {{1, 2, 3}}).serialised());
  }
  const auto log = content();
  EXPECT_EQ(log.imu.size(), 3U);
  EXPECT_EQ(log.counters.imu_stamps_ahead, 2U);
  EXPECT_EQ(log.counters.imu_stamps_back, 0U);
  EXPECT_EQ(log.scans.size(), 3U);
  EXPECT_EQ(log.counters.scan_stamps_ahead, 1U);
}

TEST_F(BagLog, AClockThatIsSetForwardIsFollowed) {
  for (const TimeNs t : {TimeNs{0}, TimeNs{1}, 1000 * kSecond, 1000 * kSecond + 1}) {
    bag.add(imu_at(kStart + t));
  }
  bag.add(plain_cloud(kStart, {{1, 2, 3}}));
  bag.add(plain_cloud(kStart + 1000 * kSecond, {{1, 2, 3}}));
  const auto log = content();
  EXPECT_EQ(log.imu.size(), 4U);
  EXPECT_EQ(log.scans.size(), 2U);
  EXPECT_EQ(log.counters.imu_stamps_ahead + log.counters.scan_stamps_ahead, 0U);
}

TEST_F(BagLog, BadMessagesAreCountedAndSurvived) {
  add_imu();
  bag.add(1, kStart, "not an imu message");
  bag.add(1, kStart, ros::serialise_imu(imu_at(kStart + 5), 0, "imu") + "x");
  const auto good = plain_cloud(kStart, {{1, 2, 3}, {4, 5, 6}});
  bag.add(good);
  const auto bad = [&](auto&& change) {
    CloudBytes cloud = good;
    cloud.stamp += kPeriod;
    change(cloud);
    bag.add(cloud);
  };
  bad([](CloudBytes& c) { c.data.pop_back(); });
  bad([](CloudBytes& c) { c.width = 3; });
  bad([](CloudBytes& c) { c.width = c.height = 0xffffffff; });
  bad([](CloudBytes& c) { c.point_step = 0; });
  bad([](CloudBytes& c) {
    c.height = 2;
    c.row_step = 0;
  });
  bad([](CloudBytes& c) { c.fields[2].offset = 9; });  // z ends behind the point
  bad([](CloudBytes& c) { c.fields[0].code = kI16; });
  bad([](CloudBytes& c) { c.fields.pop_back(); });
  auto cut = good.serialised();
  bag.add(0, kStart + kSecond, cut.substr(0, cut.size() - 1));
  bag.add(0, kStart + kSecond, "");
  const auto log = content();
  EXPECT_EQ(log.imu.size(), 1U);
  EXPECT_EQ(log.scans.size(), 1U);
  EXPECT_EQ(log.counters.bad_messages, 12U);
}

TEST_F(BagLog, RowsMayBePaddedAndOrganised) {
  add_imu();
  CloudBytes cloud;
  cloud.height = 2;
  cloud.width = 3;
  cloud.row_step = 3 * 12 + 5;
  for (int row = 0; row < 2; ++row) {
    for (int i = 0; i < 3; ++i) {
      for (const float v : {1.0F + static_cast<float>(3 * row + i), 2.0F, 3.0F}) {
        files::append(cloud.data, v);
      }
    }
    if (row == 0) cloud.data += "#####";
  }
  bag.add(cloud);
  const auto log = content();
  ASSERT_EQ(log.scans.at(0).points.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(log.scans[0].points[i].x, static_cast<float>(i + 1));
  }
}

TEST_F(BagLog, FieldsOfOtherTypesAndBigEndianAreRead) {
  add_imu();
  for (const bool big : {false, true}) {
    CloudBytes cloud;
    cloud.stamp = kStart + (big ? kPeriod : 0);
    cloud.big_endian = big;
    cloud.fields = {{"channel", 0, kU8}, {"x", 1, kF64, 0},       {"y", 9, kF64},
                    {"z", 17, kF64},     {"intensity", 25, kU16}, {"rgb", 0, kF32}};
    cloud.point_step = 27;
    cloud.width = 2;
    const auto put = [&](auto value) {
      std::string bytes;
      files::append(bytes, value);
      if (big) bytes = std::string(bytes.rbegin(), bytes.rend());
      cloud.data += bytes;
    };
    for (int i = 0; i < 2; ++i) {
      put(static_cast<std::uint8_t>(200 + i));
      for (const double v : {1.5, -2.5, 1e-3}) put(v);
      put(std::uint16_t{40000});
    }
    bag.add(cloud);
  }
  const auto log = content();
  ASSERT_EQ(log.scans.size(), 2U);
  for (const auto& scan : log.scans) {
    ASSERT_EQ(scan.points.size(), 2U);
    EXPECT_TRUE(scan.has_ring);
    EXPECT_EQ(scan.points[1].ring, 201);
    EXPECT_EQ(scan.points[1].x, 1.5F);
    EXPECT_EQ(scan.points[1].z, 1e-3F);
    EXPECT_EQ(scan.points[1].intensity, 40000);
  }
}

TEST_F(BagLog, TheLayoutMayChangeAsLongAsTheTimesDoNot) {
  add_imu();
  auto cloud = timed_cloud<float>(kStart, "time", kF32, {0, 0.09F});
  bag.add(cloud);
  cloud.stamp += kPeriod;
  cloud.fields[0].name = "y";
  cloud.fields[1].name = "x";
  bag.add(cloud);
  cloud.stamp += kPeriod;
  cloud.fields[3].name = "t";
  bag.add(cloud);
  const auto log = content();
  ASSERT_EQ(log.scans.size(), 2U);
  EXPECT_EQ(log.scans[0].points[1].x, 2);
  EXPECT_EQ(log.scans[1].points[1].x, 2);
  EXPECT_EQ(log.scans[1].points[0].y, 1);
  EXPECT_EQ(log.counters.bad_messages, 1U);
}

TEST_F(BagLog, ASliceDeliversItsScansAndAllImu) {
  for (int i = 0; i < 10; ++i) {
    add_imu(kStart + i * kPeriod);
    bag.add(plain_cloud(kStart + i * kPeriod, {{static_cast<float>(i + 1), 0, 0}}));
  }
  const auto path = bag.finish();
  const auto taken = [&path](std::int64_t start, std::int64_t stop, std::int64_t step) {
    LogOptions options;
    options.scan_start = start;
    options.scan_stop = stop;
    options.scan_step = step;
    const auto log = read_log(path, options);
    EXPECT_EQ(log.imu.size(), 10U);
    EXPECT_EQ(log.counters.scans, log.scans.size());
    std::vector<int> numbers;
    for (const auto& scan : log.scans) numbers.push_back(static_cast<int>(scan.points[0].x) - 1);
    return numbers;
  };
  EXPECT_THAT(taken(1, -1, 2), ElementsAre(1, 3, 5, 7, 9));
  EXPECT_THAT(taken(2, 5, 1), ElementsAre(2, 3, 4));
  EXPECT_THAT(taken(8, 100, 1), ElementsAre(8, 9));
  EXPECT_THAT(taken(0, 0, 1), ElementsAre());
}

TEST_F(BagLog, SkippedScansAreNotDecoded) {
  add_imu();
  for (int i = 0; i < 4; ++i) {
    auto cloud = plain_cloud(kStart + i * kPeriod, {{1, 2, 3}});
    if (i % 2 == 0) cloud.width = 9;  // would be a bad message
    bag.add(cloud);
  }
  LogOptions options;
  options.scan_start = 1;
  options.scan_step = 2;
  const auto log = content(options);
  EXPECT_EQ(log.scans.size(), 2U);
  EXPECT_EQ(log.counters.bad_messages, 0U);
}

TEST_F(BagLog, ASliceHasThePeriodOfTheLog) {
  add_imu();
  for (int i = 0; i < 6; ++i) {
    bag.add(i == 4 ? plain_cloud(kStart + i * kPeriod, {})
                   : plain_cloud(kStart + i * kPeriod, {{1, 2, 3}}));
  }
  LogOptions options;
  options.scan_step = 2;
  const auto log = content(options);
  ASSERT_EQ(log.scans.size(), 3U);
  EXPECT_EQ(log.scans[2].end_time - log.scans[2].stamp, kPeriod);
}

TEST_F(BagLog, ProgressAndDurationSpanTheLog) {
  add_imu(kStart);
  bag.add(plain_cloud(kStart, {{1, 2, 3}}));
  add_imu(kStart + 2 * kSecond);
  auto log = open_log(bag.finish(), {});
  ASSERT_TRUE(log);
  EXPECT_EQ((*log)->progress(), 0);
  EXPECT_EQ((*log)->duration(), 2 * kSecond);
  drain(**log);
  EXPECT_EQ((*log)->progress(), 1);
  EXPECT_FALSE((*log)->next()->has_value());  // stays at the end
}

}  // namespace
}  // namespace holdfast::io::testing
