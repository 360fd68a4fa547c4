#include "simulation/events/event.hpp"
#include "simulation/events/event_reference.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace holdfast::simulation {
namespace {

using ::testing::HasSubstr;

TEST(Event, IsParsedFromNameStartAndDuration) {
  const EventSpec kidnap = *parse_event("kidnap@30");
  EXPECT_EQ(kidnap.kind, EventKind::kKidnap);
  EXPECT_EQ(kidnap.start, 30 * kSecond);
  EXPECT_EQ(kidnap.duration, 0);
  EXPECT_EQ(parse_event("crowd@3")->duration, 10 * kSecond);
  EXPECT_EQ(parse_event("crowd@3+4")->duration, 4 * kSecond);
  EXPECT_EQ(parse_event("kidnap@30+6")->duration, 6 * kSecond);
  const EventSpec blind = *parse_event("blind@12.5+0.75");
  EXPECT_EQ(blind.kind, EventKind::kBlind);
  EXPECT_EQ(blind.start, 12'500'000'000);
  EXPECT_EQ(blind.duration, 750'000'000);
  EXPECT_EQ(parse_event("blind@1")->duration, 2 * kSecond);
  EXPECT_EQ(parse_event("imu_bias_jump@0.000000001")->start, 1);
  EXPECT_EQ(parse_event("lidar_off@4+0.5")->kind, EventKind::kLidarOff);
  EXPECT_EQ(parse_event("imu_off@4")->kind, EventKind::kImuOff);
  EXPECT_EQ(parse_event("imu_off@4")->duration, 2 * kSecond);
  EXPECT_EQ(parse_event("clock_jump@4")->duration, 0) << "for good";
  EXPECT_EQ(parse_event("clock_jump@4+3")->duration, 3 * kSecond);
}

TEST(Event, EachStandsInTheReference) {
  for (const std::string_view name : event_names()) {
    EXPECT_THAT(event_reference(), HasSubstr("| `" + std::string(name) + "` |"));
  }
}

TEST(Event, ErrorsShowFormNamesAndWhatWasFound) {
  for (const char* text :
       {"kidnap", "kidnap@", "kidnap@x", "kidnap@-1", "blind@3+", "blind@3+0", "blind@3+x",
        "kidnap@3+0", "imu_bias_jump@3+1", "teleport@3", "@3", ""}) {
    const auto event = parse_event(text);
    ASSERT_FALSE(event) << text;
    EXPECT_THAT(event.error().message, HasSubstr("NAME@T0[+DURATION]"));
    EXPECT_THAT(event.error().message,
                HasSubstr("blind, lidar_off, imu_off, imu_bias_jump, kidnap, clock_jump, crowd"));
  }
  EXPECT_THAT(parse_event("teleport@3").error().message, HasSubstr("found the name 'teleport'"));
}

TEST(Event, IsWrittenWithExactTimes) {
  SimulatedEvent event;
  event.kind = EventKind::kBlind;
  event.t0 = 1'700'000'012'345'678'901;
  event.t1 = 1'700'000'013'000'000'000;
  EXPECT_EQ(event_json(event),
            R"({"t0":1700000012.345678901,"t1":1700000013.000000000,"event":"blind"})");
}

TEST(Event, AClockJumpSaysItsSize) {
  SimulatedEvent event;
  event.kind = EventKind::kClockJump;
  event.t0 = event.t1 = 5 * kSecond;
  event.clock_step_s = -0.0423;
  EXPECT_EQ(event_json(event), R"({"t0":5.000000000,"t1":5.000000000,"event":"clock_jump",)"
                               R"("step_s":-0.042300000})");
}

TEST(Event, AKidnapSaysFromWhereToWhere) {
  SimulatedEvent event;
  event.kind = EventKind::kKidnap;
  event.t0 = event.t1 = kSecond;
  event.pose_after.translation = {3, 4, 0};
  event.pose_after.rotation = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  const std::string json = event_json(event);
  EXPECT_THAT(json, HasSubstr(R"("distance_m":5.000000,"angle_deg":90.000000)"));
  EXPECT_THAT(json, HasSubstr(R"("pose_before":[0.000000,)"));
  EXPECT_THAT(json, HasSubstr(R"("pose_after":[3.000000,4.000000,)"));
  EXPECT_THAT(json, HasSubstr(R"("event":"kidnap","pose_before")"));
  event.carried = true;
  EXPECT_THAT(event_json(event), HasSubstr(R"("event":"kidnap","carried":true,"pose_before":[)"));
}

}  // namespace
}  // namespace holdfast::simulation
