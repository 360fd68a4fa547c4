#include "benchmarks/relocalization/recovery_drive.hpp"

#include <gtest/gtest.h>

namespace holdfast::benchmarks {
namespace {

constexpr TimeNs kLost = 100 * kSecond;

/// The robot stands at the origin; scans are 0.1 s apart.
SE3 truth(TimeNs) { return {}; }

TimeNs time_of(int scan) { return kLost + scan * (kSecond / 10); }

/// 10 s: LOST, from scan `found` on TRACKING at `x` m.
std::vector<StepReport> steps(int found, double x) {
  std::vector<StepReport> all(100);
  for (int i = 0; i < 100; ++i) {
    StepReport& step = all[static_cast<std::size_t>(i)];
    step.pose_time = time_of(i);
    step.state = i < found ? State::kLost : State::kTracking;
    step.T_map_body.translation.x() = x;
  }
  return all;
}

Recovery score(const std::vector<StepReport>& all, TimeNs until = time_of(100)) {
  Recovery loss;
  loss.t = loss.apart = kLost;
  return score_recovery(loss, all, until, truth);
}

void accept_a_search_at(int scan, std::vector<StepReport>& all) {
  SearchSummary search;
  search.accepted = true;
  search.cpu_ms = 30;
  all[static_cast<std::size_t>(scan)].search = std::make_shared<const SearchSummary>(search);
}

TEST(Recovery, CountsFromTheLossToTheFirstOfTwoGoodSeconds) {
  auto all = steps(7, 0.1);
  accept_a_search_at(7, all);
  const Recovery r = score(all);
  ASSERT_TRUE(r.found_after_s);
  EXPECT_NEAR(*r.found_after_s, 0.7, 1e-9);
  EXPECT_EQ(r.searches, 1);
  EXPECT_EQ(r.search_ms, 30);
  EXPECT_EQ(r.false_relocalizations, 0);
  EXPECT_EQ(r.misleading_s, 0);
}

TEST(Recovery, AScanInDoubtBeginsTheTwoSecondsAnew) {
  auto all = steps(7, 0.1);
  all[20].state = State::kSuspect;
  EXPECT_NEAR(*score(all).found_after_s, 2.1, 1e-9);
}

TEST(Recovery, IsNoneBeforeTheNextLoss) {
  EXPECT_FALSE(score(steps(7, 0.1), time_of(25)).found_after_s);
  EXPECT_TRUE(score(steps(7, 0.1), time_of(28)).found_after_s);
}

TEST(Recovery, AWrongPoseThatWasTakenOverIsFalseAndMisleads) {
  auto all = steps(10, 0.6);
  accept_a_search_at(10, all);
  const Recovery r = score(all);
  EXPECT_FALSE(r.found_after_s);
  EXPECT_EQ(r.false_relocalizations, 1);
  EXPECT_NEAR(r.misleading_s, 9.0, 1e-9);
}

TEST(Recovery, WherePlacesAreAlikeTheTimeCountsFromTheEndOfThat) {
  Recovery loss;
  loss.t = kLost;
  loss.apart = time_of(30);
  EXPECT_NEAR(*score_recovery(loss, steps(35, 0), time_of(100), truth).found_after_s, 0.5, 1e-9);
  EXPECT_EQ(*score_recovery(loss, steps(10, 0), time_of(100), truth).found_after_s, 0);
}

}  // namespace
}  // namespace holdfast::benchmarks
