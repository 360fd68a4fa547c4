#include "benchmarks/drives/drive_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace holdfast::benchmarks {
namespace {

TEST(DriveCases, AreTheDriveAsItIsAChangedWorldAndEachEvent) {
  const auto cases = drive_cases(60);
  ASSERT_EQ(cases.size(), 4 + simulation::event_names().size());
  EXPECT_EQ(cases[0].name, "nominal");
  EXPECT_TRUE(cases[0].events.empty());
  EXPECT_EQ(cases[0].changed_share, 0);
  EXPECT_EQ(cases[1].changed_share, 0.2);
  for (const std::string_view name : simulation::event_names()) {
    EXPECT_TRUE(std::any_of(cases.begin(), cases.end(), [&](const DriveCase& what) {
      return what.name == name;
    })) << name;
  }
}

TEST(DriveCases, LieWithinTheDriveAndLeaveTimeToRecover) {
  for (const double duration_s : {4.0, 60.0, 600.0}) {
    for (const DriveCase& what : drive_cases(duration_s)) {
      for (const auto& event : what.events) {
        EXPECT_GE(event.start, from_seconds(0.3 * duration_s));
        EXPECT_LE(event.start + event.duration, from_seconds(0.6 * duration_s));
        const bool carried = event.kind == simulation::EventKind::kKidnap && event.duration > 0;
        EXPECT_EQ(carried ? "carried" : event_name(event.kind), what.name);
      }
    }
  }
}

}  // namespace
}  // namespace holdfast::benchmarks
