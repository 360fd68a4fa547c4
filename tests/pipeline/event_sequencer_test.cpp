#include "holdfast/pipeline/event_sequencer.hpp"

#include <gtest/gtest.h>

#include <string>

namespace holdfast::pipeline {
namespace {

constexpr TimeNs kMs = 1'000'000;
constexpr TimeNs kPatience = 100 * kMs;

SensorEvent imu(TimeNs t_ms) {
  ImuSample sample;
  sample.t = t_ms * kMs;
  return sample;
}

SensorEvent scan(TimeNs begin_ms, TimeNs end_ms) {
  Scan s;
  s.stamp = begin_ms * kMs;
  s.end_time = end_ms * kMs;
  return s;
}

/// Everything that is ready now: "i10 s100 ..." with times (of a scan: its end) in ms.
std::string ready(EventSequencer& sequencer) {
  std::string text;
  SensorEvent event;
  while (sequencer.pop(event)) {
    if (!text.empty()) text += ' ';
    const auto* sample = std::get_if<ImuSample>(&event);
    text += sample != nullptr ? 'i' : 's';
    text += std::to_string((sample != nullptr ? sample->t : std::get<Scan>(event).end_time) / kMs);
  }
  return text;
}

TEST(EventSequencer, ImuPassesAtOnce) {
  EventSequencer sequencer(kPatience);
  EXPECT_EQ(ready(sequencer), "");
  sequencer.push(imu(10));
  EXPECT_EQ(ready(sequencer), "i10");
  sequencer.push(imu(20));
  sequencer.push(imu(30));
  EXPECT_EQ(ready(sequencer), "i20 i30");
}

TEST(EventSequencer, AScanWaitsForImuThatCoversItsEnd) {
  EventSequencer sequencer(kPatience);
  sequencer.push(imu(90));
  sequencer.push(scan(0, 100));
  EXPECT_EQ(ready(sequencer), "i90");
  sequencer.push(imu(99));
  EXPECT_EQ(ready(sequencer), "i99");
  sequencer.push(imu(101));
  EXPECT_EQ(ready(sequencer), "i101 s100");
}

TEST(EventSequencer, ImuExactlyAtTheEndIsEnough) {
  EventSequencer sequencer(kPatience);
  sequencer.push(imu(100));
  sequencer.push(scan(0, 100));
  EXPECT_EQ(ready(sequencer), "i100 s100");
}

TEST(EventSequencer, AScanDoesNotOvertakeImuThatCameBeforeIt) {
  EventSequencer sequencer(kPatience);
  sequencer.push(imu(95));
  sequencer.push(imu(105));
  sequencer.push(scan(0, 100));
  sequencer.push(imu(110));
  EXPECT_EQ(ready(sequencer), "i95 i105 s100 i110");
}

TEST(EventSequencer, ScansComeInTheOrderOfTheirEnds) {
  EventSequencer sequencer(kPatience);
  sequencer.push(scan(50, 150));
  sequencer.push(scan(0, 100));  // the log holds them the wrong way round
  sequencer.push(imu(250));
  EXPECT_EQ(ready(sequencer), "i250 s100 s150");
}

TEST(EventSequencer, ScansWithOneEndKeepTheOrderOfTheLog) {
  EventSequencer sequencer(kPatience);
  sequencer.push(scan(20, 100));
  sequencer.push(scan(10, 100));
  sequencer.push(imu(100));
  SensorEvent event;
  ASSERT_TRUE(sequencer.pop(event));  // the reading
  ASSERT_TRUE(sequencer.pop(event));
  EXPECT_EQ(std::get<Scan>(event).stamp, 20 * kMs);
  ASSERT_TRUE(sequencer.pop(event));
  EXPECT_EQ(std::get<Scan>(event).stamp, 10 * kMs);
}

TEST(EventSequencer, WhenTheImuStopsAScanIsLetGoOnceTheLogIsPastItsPatience) {
  EventSequencer sequencer(kPatience);
  sequencer.push(imu(50));
  sequencer.push(scan(0, 100));
  EXPECT_EQ(ready(sequencer), "i50");
  sequencer.push(scan(99, 199));
  EXPECT_EQ(ready(sequencer), "");
  sequencer.push(scan(100, 200));  // 100 ms past the first end
  EXPECT_EQ(ready(sequencer), "s100");
  sequencer.push(scan(200, 300));
  EXPECT_EQ(ready(sequencer), "s199 s200");
}

TEST(EventSequencer, WithoutAnyImuScansStillPass) {
  EventSequencer sequencer(kPatience);
  for (int k = 0; k < 4; ++k) sequencer.push(scan(100 * k, 100 * k + 100));
  EXPECT_EQ(ready(sequencer), "s100 s200 s300");
  sequencer.finish();
  EXPECT_EQ(ready(sequencer), "s400");
}

TEST(EventSequencer, AtTheEndEverythingThatWaitsIsReady) {
  EventSequencer sequencer(kPatience);
  sequencer.push(imu(50));
  sequencer.push(scan(0, 100));
  sequencer.push(scan(50, 150));
  EXPECT_EQ(ready(sequencer), "i50");
  sequencer.finish();
  EXPECT_EQ(ready(sequencer), "s100 s150");
  EXPECT_EQ(ready(sequencer), "");
}

TEST(EventSequencer, ImuThatStampsBackPassesForTheBufferToRefuse) {
  EventSequencer sequencer(kPatience);
  sequencer.push(imu(100));
  sequencer.push(imu(90));
  sequencer.push(scan(0, 95));
  EXPECT_EQ(ready(sequencer), "i100 i90 s95");
}

}  // namespace
}  // namespace holdfast::pipeline
