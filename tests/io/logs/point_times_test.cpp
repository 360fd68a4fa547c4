#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/io/logs/log_content.hpp"
#include "tests/io/logs/message_builder.hpp"
#include "tests/io/temporary_folder.hpp"

namespace holdfast::io::testing {
namespace {

/// Times of five points in ns from the first: not in order, as drivers with several lasers give
/// them.
const std::vector<TimeNs> kTimes = {40'000'000, 0, 99'000'000, 20'000'000, 20'000'000};
constexpr TimeNs kSweep = 99'000'000;

struct PointTimes : ::testing::Test {
  TemporaryFolder folder;

  /// Three scans with stamps `stamp_shift` after the first point, whose raw time is
  /// round(scale * (t + shift(stamp of the first point))).
  template <class T, class Shift>
  LogContent log_with(const std::string& field, Code code, double units_a_second,
                      const Shift& shift, TimeNs stamp_shift = 0, TimeNs start = kStart,
                      std::uint32_t count = 1) {
    BagBytes bag(folder / "log.bag");
    bag.add(imu_at(start));
    for (int i = 0; i < 3; ++i) {
      const TimeNs first = start + i * kPeriod;
      std::vector<T> times;
      for (const TimeNs t : kTimes) {
        const auto raw = static_cast<long double>(t + shift(first)) * units_a_second * 1e-9L;
        times.push_back(std::is_integral_v<T> ? static_cast<T>(std::llround(raw))
                                              : static_cast<T>(raw));
      }
      bag.add(timed_cloud<T>(first + stamp_shift, field, code, times, count));
    }
    return read_log(bag.finish());
  }

  static void expect_sweeps(const LogContent& log, TimeNs tolerance, TimeNs start = kStart) {
    ASSERT_EQ(log.scans.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      const Scan& scan = log.scans[i];
      const TimeNs first = start + static_cast<TimeNs>(i) * kPeriod;
      EXPECT_TRUE(scan.has_point_times);
      EXPECT_NEAR(static_cast<double>(scan.stamp - first), 0, static_cast<double>(tolerance));
      EXPECT_NEAR(static_cast<double>(scan.end_time - first - kSweep), 0,
                  static_cast<double>(tolerance));
      ASSERT_EQ(scan.points.size(), kTimes.size());
      for (std::size_t k = 0; k < kTimes.size(); ++k) {
        EXPECT_GE(scan.points[k].time_offset_ns, 0);
        const TimeNs t = scan.stamp + scan.points[k].time_offset_ns;
        EXPECT_NEAR(static_cast<double>(t - first - kTimes[k]), 0, static_cast<double>(tolerance));
      }
    }
  }
};

/// Raw times that count from the first point, from a time before it, or from the epoch.
TimeNs from_first(TimeNs) { return 0; }
TimeNs from_last(TimeNs) { return -kSweep; }
TimeNs from_epoch(TimeNs stamp) { return stamp; }

// What a type can hold at the sizes here, rounded up: float32 at 0.1 s, float64 seconds since 1970,
// float64 nanoseconds since 1970, whole microseconds.
constexpr TimeNs kFloat32 = 8;
constexpr TimeNs kFloat64Epoch = 240;
constexpr TimeNs kFloat64EpochNs = 256;
constexpr TimeNs kMicrosecond = 1000;

TEST_F(PointTimes, EveryNameOfTheFieldIsKnown) {
  for (const char* name : {"time", "t", "timestamp", "time_offset", "offset_time"}) {
    const auto log = log_with<std::uint32_t>(name, kU32, 1e9, from_first);
    expect_sweeps(log, 0);
    EXPECT_EQ(log.times.field, name);
  }
}

TEST_F(PointTimes, OffsetsInEveryUnitAndTypeAreFound) {
  const auto in_s = log_with<float>("time", kF32, 1, from_first);
  expect_sweeps(in_s, kFloat32);
  EXPECT_EQ(in_s.times.unit, "s");
  EXPECT_FALSE(in_s.times.absolute);
  expect_sweeps(log_with<double>("time", kF64, 1, from_first), 1);
  const auto in_ms = log_with<float>("time", kF32, 1e3, from_first);
  expect_sweeps(in_ms, kFloat32);
  EXPECT_EQ(in_ms.times.unit, "ms");
  const auto in_us = log_with<std::uint32_t>("time", kU32, 1e6, from_first);
  expect_sweeps(in_us, 0);
  EXPECT_EQ(in_us.times.unit, "us");
  expect_sweeps(log_with<float>("time", kF32, 1e6, from_first), kFloat32);
  const auto in_ns = log_with<std::int32_t>("time", kI32, 1e9, from_first);
  expect_sweeps(in_ns, 0);
  EXPECT_EQ(in_ns.times.unit, "ns");
  expect_sweeps(log_with<double>("time", kF64, 1e9, from_first), 0);
}

TEST_F(PointTimes, NegativeOffsetsFromTheEndOfTheSweepMoveTheStamp) {
  const auto log = log_with<float>("time", kF32, 1, from_last, kSweep);
  expect_sweeps(log, kFloat32);
  EXPECT_FALSE(log.times.absolute);
  expect_sweeps(log_with<std::int32_t>("t", kI32, 1e9, from_last, kSweep), 0);
  expect_sweeps(log_with<std::int32_t>("t", kI32, 1e6, from_last, kSweep), 0);
}

TEST_F(PointTimes, AbsoluteStampsInEveryUnitAreFound) {
  const auto in_s = log_with<double>("timestamp", kF64, 1, from_epoch);
  expect_sweeps(in_s, kFloat64Epoch);
  EXPECT_TRUE(in_s.times.absolute);
  EXPECT_EQ(in_s.times.unit, "s");
  expect_sweeps(log_with<double>("timestamp", kF64, 1e6, from_epoch), kFloat64Epoch);
  const auto in_ns = log_with<double>("timestamp", kF64, 1e9, from_epoch);
  expect_sweeps(in_ns, kFloat64EpochNs);
  EXPECT_EQ(in_ns.times.unit, "ns");
}

TEST_F(PointTimes, AbsoluteStampsDoNotNeedAStampAtTheFirstPoint) {
  for (const TimeNs shift : {kSweep, kSweep / 2, kSecond / 2}) {
    expect_sweeps(log_with<double>("timestamp", kF64, 1, from_epoch, shift), kFloat64Epoch);
  }
}

TEST_F(PointTimes, SixtyFourBitIntegersLoseNothing) {
  expect_sweeps(log_with<std::uint64_t>("t", kU32, 1e9, from_epoch, 0, kStart + 123456789, 2), 0,
                kStart + 123456789);
  expect_sweeps(log_with<std::uint64_t>("t", kU8, 1e6, from_epoch, 0, kStart, 8), kMicrosecond);
  const auto relative = log_with<std::uint64_t>("t", kU32, 1e9, from_first, 0, kStart, 2);
  expect_sweeps(relative, 0);
  EXPECT_FALSE(relative.times.absolute);
}

TEST_F(PointTimes, AHeaderStampBeforeTheFirstReturnIsKept) {
  // The sweep began 3 ms before something was seen: header.stamp is the contract.
  const auto log = log_with<std::uint32_t>(
      "t", kU32, 1e9, [](TimeNs) { return 3'000'000; }, -3'000'000);
  ASSERT_EQ(log.scans.size(), 3U);
  EXPECT_EQ(log.scans[0].stamp, kStart - 3'000'000);
  EXPECT_EQ(log.scans[0].points[1].time_offset_ns, 3'000'000);
  EXPECT_EQ(log.scans[0].end_time, kStart + kSweep);
}

TEST_F(PointTimes, AClockOfTheSensorsOwnBeginsAtTheStamp) {
  // Seconds since power-on, beside a header in the robot's time.
  const auto log = log_with<double>("timestamp", kF64, 1,
                                    [](TimeNs stamp) { return stamp - kStart + 4321 * kSecond; });
  expect_sweeps(log, 2);
  EXPECT_TRUE(log.times.own_clock);
  EXPECT_FALSE(log.times.absolute);
  // Microseconds since the top of the hour.
  expect_sweeps(
      log_with<std::uint32_t>("timestamp", kU32, 1e6,
                              [](TimeNs stamp) { return stamp - kStart + 1800 * kSecond; }),
      kMicrosecond);
}

TEST_F(PointTimes, ASimulationThatBeginsAtZeroIsTold) {
  const auto absolute = log_with<double>("t", kF64, 1, from_epoch, 0, 0);
  expect_sweeps(absolute, 1, 0);
  EXPECT_TRUE(absolute.times.absolute);
  const auto relative = log_with<double>("t", kF64, 1, from_first, 0, 0);
  expect_sweeps(relative, 1, 0);
  EXPECT_FALSE(relative.times.absolute);
}

TEST_F(PointTimes, ASlowSensorsMillisecondsAreNotTakenForSeconds) {
  BagBytes bag(folder / "log.bag");
  bag.add(imu_at(kStart));
  for (int i = 0; i < 3; ++i) {
    bag.add(timed_cloud<float>(kStart + i * kSecond, "time", kF32, {0, 0.5F, 0.9F}));
  }
  const auto log = read_log(bag.finish());
  EXPECT_EQ(log.times.unit, "s");
  EXPECT_EQ(log.scans.at(2).end_time, kStart + 2 * kSecond + 899'999'976);  // 0.9F
}

TEST_F(PointTimes, PartOfASweepDoesNotChangeTheUnit) {
  BagBytes bag(folder / "log.bag");
  bag.add(imu_at(kStart));
  bag.add(timed_cloud<std::uint32_t>(kStart, "t", kU32, {500, 1500}));  // one corner was seen
  bag.add(timed_cloud<std::uint32_t>(kStart + kPeriod, "t", kU32, {0, 99'000'000}));
  bag.add(timed_cloud<std::uint32_t>(kStart + 2 * kPeriod, "t", kU32, {7}));
  const auto log = read_log(bag.finish());
  ASSERT_EQ(log.scans.size(), 3U);
  EXPECT_EQ(log.scans[0].end_time, kStart + 1500);
  EXPECT_EQ(log.scans[1].end_time, kStart + kPeriod + 99'000'000);
  EXPECT_EQ(log.scans[2].end_time, kStart + 2 * kPeriod + 7);
}

TEST_F(PointTimes, AFieldThatNeverChangesIsNoTime) {
  BagBytes bag(folder / "log.bag");
  bag.add(imu_at(kStart));
  for (int i = 0; i < 3; ++i) {
    bag.add(timed_cloud<float>(kStart + i * kPeriod, "time", kF32, {0, 0, 0}));
  }
  const auto log = read_log(bag.finish());
  EXPECT_FALSE(log.scans.at(0).has_point_times);
  EXPECT_EQ(log.scans[0].end_time, kStart);
  EXPECT_TRUE(log.times.field.empty());
}

TEST_F(PointTimes, PointsWithImpossibleTimesAreDroppedAndCounted) {
  BagBytes bag(folder / "log.bag");
  bag.add(imu_at(kStart));
  for (int i = 0; i < 6; ++i) {
    std::vector<float> times = {0, 0.05F, 0.09F};
    if (i == 5) times = {0, std::nanf(""), 1e30F, -1e30F, 5.0F, 0.09F};
    bag.add(timed_cloud<float>(kStart + i * kPeriod, "time", kF32, times));
  }
  const auto log = read_log(bag.finish());
  ASSERT_EQ(log.scans.size(), 6U);
  EXPECT_EQ(log.scans[5].points.size(), 2U);
  EXPECT_EQ(log.scans[5].points[1].x, 6);
  EXPECT_EQ(log.scans[5].stamp, kStart + 5 * kPeriod);
  EXPECT_EQ(log.counters.invalid_points, 4U);
}

TEST_F(PointTimes, NoReturnsDoNotCountAsTimes) {
  // Drivers fill what was not seen with zeros, which are far from absolute stamps.
  BagBytes bag(folder / "log.bag");
  bag.add(imu_at(kStart));
  for (int i = 0; i < 2; ++i) {
    const double t = 1.7e9 + 0.1 * i;
    auto cloud = timed_cloud<double>(kStart + i * kPeriod, "timestamp", kF64, {t, 0, t + 0.0625});
    for (std::size_t byte = 20; byte < 40; ++byte) cloud.data[byte] = 0;
    bag.add(cloud);
  }
  const auto log = read_log(bag.finish());
  ASSERT_EQ(log.scans.size(), 2U);
  EXPECT_TRUE(log.times.absolute);
  EXPECT_EQ(log.scans[0].points.size(), 2U);
  EXPECT_EQ(log.scans[0].end_time, kStart + 62'500'000);
  EXPECT_EQ(log.counters.invalid_points + log.counters.no_return_points, 2U);
}

TEST_F(PointTimes, ScansWithoutPointsAtTheStartDelayTheDecision) {
  BagBytes bag(folder / "log.bag");
  bag.add(imu_at(kStart));
  for (int i = 0; i < 150; ++i) bag.add(plain_cloud(kStart + i * kPeriod, {}));
  bag.add(timed_cloud<std::uint32_t>(kStart + 150 * kPeriod, "t", kU32, {0, 99'000'000}));
  const auto log = read_log(bag.finish());
  ASSERT_EQ(log.scans.size(), 151U);
  EXPECT_EQ(log.scans[150].end_time - log.scans[150].stamp, 99'000'000);
  EXPECT_EQ(log.times.unit, "ns");
}

}  // namespace
}  // namespace holdfast::io::testing
