#include "holdfast/io/bag_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "holdfast/core/random.hpp"
#include "tests/io/logs/log_content.hpp"
#include "tests/io/logs/message_builder.hpp"
#include "tests/io/temporary_folder.hpp"

namespace holdfast::io::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Scan make_scan(TimeNs stamp, std::size_t points, RandomStream& random) {
  Scan scan;
  scan.stamp = stamp;
  scan.has_ring = true;
  scan.has_point_times = true;
  for (std::size_t i = 0; i < points; ++i) {
    ScanPoint p;
    p.x = static_cast<float>(random.uniform(-50, 50));
    p.y = static_cast<float>(random.uniform(-50, 50));
    p.z = static_cast<float>(random.uniform(-5, 5));
    p.intensity = static_cast<float>(random.below(256));
    p.ring = static_cast<std::uint16_t>(i % 16);
    p.time_offset_ns = static_cast<std::int32_t>(i * 99'000'000 / points);
    scan.points.push_back(p);
  }
  scan.end_time = stamp + (points == 0 ? kPeriod : scan.points.back().time_offset_ns);
  return scan;
}

struct BagRoundTrip : ::testing::Test {
  TemporaryFolder folder;
  RandomStream random{1, "bag_round_trip"};

  std::filesystem::path write(std::string_view name, const std::vector<SensorEvent>& events,
                              bool compress = false) {
    const auto path = folder / name;
    auto writer = BagWriter::create(path, {}, compress);
    EXPECT_TRUE(writer) << writer.error().message;
    for (const auto& event : events) {
      EXPECT_TRUE(std::visit([&](const auto& e) { return (*writer)->write(e); }, event));
    }
    EXPECT_TRUE((*writer)->close());
    return path;
  }
  /// 12 s, enough for several chunks.
  std::vector<SensorEvent> drive() {
    std::vector<SensorEvent> events;
    for (int i = 0; i < 120; ++i) {
      const TimeNs stamp = kStart + i * kPeriod;
      for (int k = 0; k < 20; ++k) events.emplace_back(imu_at(stamp + k * kPeriod / 20));
      events.emplace_back(make_scan(stamp, 1800, random));
    }
    return events;
  }
};

TEST_F(BagRoundTrip, ScansAndSamplesComeBackAsTheyWere) {
  const auto events = drive();
  for (const bool compress : {false, true}) {
    const auto log = read_log(write("a.bag", events, compress));
    ASSERT_EQ(log.scans.size(), 120U);
    ASSERT_EQ(log.imu.size(), 2400U);
    EXPECT_FALSE(log.counters.truncated);
    EXPECT_EQ(log.times.unit, "s");
    std::size_t scan_index = 0;
    for (const auto& event : events) {
      const auto* written = std::get_if<Scan>(&event);
      if (written == nullptr) continue;
      const Scan& read = log.scans[scan_index++];
      EXPECT_EQ(read.stamp, written->stamp);
      EXPECT_TRUE(read.has_ring);
      ASSERT_EQ(read.points.size(), written->points.size());
      for (std::size_t i = 0; i < read.points.size(); ++i) {
        const ScanPoint &a = written->points[i], &b = read.points[i];
        ASSERT_EQ(std::tie(a.x, a.y, a.z, a.intensity, a.ring),
                  std::tie(b.x, b.y, b.z, b.intensity, b.ring));
        // float32 seconds below 0.125 s: steps of 7.5 ns.
        ASSERT_NEAR(a.time_offset_ns, b.time_offset_ns, 4);
      }
      EXPECT_NEAR(static_cast<double>(read.end_time - written->end_time), 0, 4);
    }
  }
}

TEST_F(BagRoundTrip, ASecondTripChangesNoBit) {
  const auto first = write("first.bag", drive());
  std::vector<SensorEvent> events;
  const auto log = read_log(first);
  std::size_t scans = 0, samples = 0;
  for (const char kind : log.order) {
    if (kind == 's')
      events.emplace_back(log.scans[scans++]);
    else
      events.emplace_back(log.imu[samples++]);
  }
  const auto second = read_log(write("second.bag", events));
  ASSERT_EQ(second.order, log.order);
  for (std::size_t k = 0; k < scans; ++k) {
    for (std::size_t i = 0; i < log.scans[k].points.size(); ++i) {
      ASSERT_EQ(second.scans[k].points[i].time_offset_ns, log.scans[k].points[i].time_offset_ns);
    }
    ASSERT_EQ(second.scans[k].end_time, log.scans[k].end_time);
  }
}

TEST_F(BagRoundTrip, TheSameInputGivesTheSameBytes) {
  const auto events = drive();
  for (const bool compress : {false, true}) {
    const auto a = read_bytes(write("a.bag", events, compress));
    const auto b = read_bytes(write("b.bag", events, compress));
    EXPECT_TRUE(a == b);
    EXPECT_EQ(a.substr(0, 13), "#ROSBAG V2.0\n");
  }
}

TEST_F(BagRoundTrip, WheelsAndSatellitesNeedATopic) {
  auto none = BagWriter::create(folder / "none.bag", {});
  EXPECT_THAT((*none)->write(WheelSample()).error().message, HasSubstr("no topic"));
  EXPECT_THAT((*none)->write(GnssSample()).error().message, HasSubstr("no topic"));
  BagWriter::Topics topics;
  topics.wheel = topics.imu;
  const auto doubled = BagWriter::create(folder / "doubled.bag", topics);
  ASSERT_FALSE(doubled);
  EXPECT_THAT(doubled.error().message, HasSubstr("'/imu' is named twice"));
  topics.wheel = {};
  topics.gnss = "/fix";
  auto gnss = BagWriter::create(folder / "gnss.bag", topics);
  EXPECT_TRUE((*gnss)->write(imu_at(kStart)));
  EXPECT_TRUE((*gnss)->write(GnssSample{.t = kStart + 1}));
  WheelSample wheel;
  wheel.t = kStart + 1;
  EXPECT_FALSE((*gnss)->write(wheel));
  EXPECT_TRUE((*gnss)->close());
}

TEST_F(BagRoundTrip, CompressionMakesTheFileSmaller) {
  std::vector<SensorEvent> events;
  for (int i = 0; i < 2000; ++i) events.emplace_back(imu_at(kStart + i));
  events.emplace_back(make_scan(kStart, 10, random));
  const auto plain = std::filesystem::file_size(write("a.bag", events));
  const auto packed = std::filesystem::file_size(write("b.bag", events, true));
  EXPECT_LT(packed, plain / 4);
}

TEST_F(BagRoundTrip, ScansWithoutRingsTimesOrPointsComeBack) {
  Scan bare = make_scan(kStart, 50, random);
  bare.has_ring = bare.has_point_times = false;
  Scan empty = make_scan(kStart + kPeriod, 0, random);
  const auto log = read_log(write("a.bag", {imu_at(kStart), bare, empty}));
  ASSERT_EQ(log.scans.size(), 2U);
  EXPECT_FALSE(log.scans[0].has_ring);
  EXPECT_FALSE(log.scans[0].has_point_times);
  EXPECT_EQ(log.scans[0].points.size(), 50U);
  EXPECT_EQ(log.scans[0].points[3].ring, 0);
  EXPECT_TRUE(log.scans[1].points.empty());
  EXPECT_EQ(log.scans[1].end_time, kStart + 2 * kPeriod);
}

TEST_F(BagRoundTrip, ALogThatBeginsAtZeroIsRead) {
  const auto log = read_log(write("a.bag", {imu_at(0), imu_at(1), make_scan(0, 5, random)}));
  EXPECT_EQ(log.order, "iis");
  EXPECT_EQ(log.imu[0].t, 0);
  EXPECT_EQ(log.scans[0].stamp, 0);
}

TEST_F(BagRoundTrip, TopicsAreAsTheyWereNamed) {
  auto writer = BagWriter::create(folder / "a.bag", {"/velodyne", "/imu/data"});
  ASSERT_TRUE(writer);
  ASSERT_TRUE((*writer)->write(imu_at(kStart)));
  ASSERT_TRUE((*writer)->write(make_scan(kStart, 5, random)));
  ASSERT_TRUE((*writer)->close());
  LogOptions options;
  options.points_topic = "/velodyne";
  options.imu_topic = "/imu/data";
  EXPECT_EQ(read_log(folder / "a.bag", options).order, "is");
}

TEST_F(BagRoundTrip, WithoutCloseNothingStaysBehind) {
  {
    auto writer = BagWriter::create(folder / "a.bag", {});
    ASSERT_TRUE(writer);
    ASSERT_TRUE((*writer)->write(make_scan(kStart, 100'000, random)));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.bag"));
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST_F(BagRoundTrip, MisuseAndImpossibleTimesAreErrors) {
  EXPECT_FALSE(BagWriter::create(folder / "none/a.bag", {}));
  const auto same = BagWriter::create(folder / "a.bag", {"/a", "/a"});
  ASSERT_FALSE(same);
  EXPECT_THAT(same.error().message,
              HasSubstr("topics '/a' and '/a': expected two different names"));
  auto writer = BagWriter::create(folder / "a.bag", {});
  ASSERT_TRUE(writer);
  for (const TimeNs t : {TimeNs{-1}, (TimeNs{1} << 32) * kSecond}) {
    const auto status = (*writer)->write(imu_at(t));
    ASSERT_FALSE(status);
    EXPECT_THAT(status.error().message, HasSubstr("cannot be written, a bag holds 0 to 2^32 s"));
  }
  ASSERT_TRUE((*writer)->close());
  EXPECT_THAT((*writer)->close().error().message, HasSubstr("already closed"));
  EXPECT_THAT((*writer)->write(imu_at(0)).error().message, HasSubstr("is closed"));
  EXPECT_THAT(folder.names(), ElementsAre("a.bag"));
}

}  // namespace
}  // namespace holdfast::io::testing
