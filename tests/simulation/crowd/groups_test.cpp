#include "simulation/crowd/groups.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/simulation/support.hpp"

namespace holdfast::simulation {
namespace {

using testing::event;
using testing::make;

GroupPlan frequent() {
  GroupPlan plan;
  plan.people = 5;
  plan.per_minute = 6;
  plan.lasts_s = 10;
  return plan;
}

TEST(Groups, DoNotComeWhereNobodyAsksForThem) {
  EXPECT_TRUE(plan_crowds({}, GroupPlan{}, 1).empty());
  EXPECT_EQ(plan_crowds({event("crowd@8+12")}, GroupPlan{}, 1).size(), 1U);
}

/// In an hour as many as the rates of gaps and lengths say: 3600 / (60 / 6 + 10), within 4 sigma of
/// the sum of their gaps (10 s each) and lengths (2.3 s each).
TEST(Groups, ComeAsOftenAsThePlanSays) {
  const auto groups = plan_crowds({}, frequent(), 3);
  EXPECT_NEAR(static_cast<double>(groups.size()), 180, 4 * std::sqrt(180.0) * 10.3 / 20);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const double lasts_s = to_seconds(groups[i].span.end - groups[i].span.begin);
    EXPECT_GE(lasts_s, 6);
    EXPECT_LE(lasts_s, 14);
    if (i > 0) EXPECT_GE(groups[i].span.begin, groups[i - 1].span.end);
  }
}

TEST(Groups, KeepAwayFromKidnapsAndCrowds) {
  const auto crowds = plan_crowds({event("kidnap@60"), event("crowd@100+10")}, frequent(), 5);
  ASSERT_GT(crowds.size(), 100U);
  EXPECT_EQ(crowds[0].span.begin, 100 * kSecond);
  for (std::size_t i = 1; i < crowds.size(); ++i) {
    const TimeSpan& span = crowds[i].span;
    EXPECT_TRUE(span.end < 60 * kSecond || span.begin > 60 * kSecond) << i;
    EXPECT_TRUE(span.end < 100 * kSecond || span.begin > 110 * kSecond) << i;
  }
}

/// Of the office's group, for a second at least, three who are nearer than 1.3 m.
TEST(Groups, StandCloseToTheRobotAndKeepClearOfIt) {
  SimulationOptions options;
  options.scenario = "office";
  options.duration_s = 60;
  int close_scans = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    options.seed = seed;
    const auto drive = make(options);
    for (TimeNs t = 0; t < 59 * kSecond; t += kSecond / 10) {
      const Eigen::Vector3d robot = drive->truth_at(drive->start_time() + t).translation;
      int close = 0;
      for (std::size_t i = 0; i < drive->people().size(); ++i) {
        if (!drive->people().is_there(i, t)) continue;
        const Eigen::Vector3d person = drive->people().at(i, t).T_map_body.translation;
        const double apart = (person - robot).head<2>().norm();
        ASSERT_GT(apart, 0.5) << "person " << i << " at " << to_seconds(t) << " s, seed " << seed;
        close += apart < 1.3;
      }
      close_scans += close >= 3;
    }
  }
  EXPECT_GT(close_scans, 10);
}

}  // namespace
}  // namespace holdfast::simulation
