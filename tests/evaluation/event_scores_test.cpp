#include "evaluation/event_scores.hpp"

#include "tests/evaluation/scenes.hpp"

namespace holdfast::evaluation::testing {
namespace {

Event event_at(const char* name, double t0, double t1) {
  Event event;
  event.name = name;
  event.t0 = from_seconds(t0);
  event.t1 = from_seconds(t1);
  return event;
}

SE3 moved(double t) { return pose(t + 30, 40, 0, 1); }

/// Carried at 20 s: the truth jumps by 30 m and 40 m, that is 50 m, and by 1 rad.
Trajectory kidnapped_truth() {
  Trajectory truth = sample(0, 20, 200, straight);
  const Trajectory after = sample(20, 40, 200, moved);
  truth.insert(truth.end(), after.begin(), after.end());
  return truth;
}

/// A run that keeps claiming the old way until 20.35 s, is then lost until `back`, from where on
/// its status is TRACKING at the right place, but for what `spoil` changes.
struct KidnapRun {
  Trajectory estimate;
  RunContext context;
};
KidnapRun kidnap_run(
    double back, const std::function<void(double, SE3&, std::string&)>& spoil =
                     [](double, SE3&, std::string&) {}) {
  KidnapRun run;
  for (const StampedPose& p : sample(0.1, 40, 10, straight)) {
    const double t = to_seconds(p.t);
    std::string status = t < 20.35 || t > back - 0.05 ? "TRACKING" : "LOST";
    SE3 claim = t < 20.35 ? straight(t) : moved(t);
    spoil(t, claim, status);
    run.context.steps.push_back(step(t, status));
    if (status_claims_pose(status)) run.estimate.push_back({p.t, claim});
  }
  run.context.events = {event_at("kidnap", 20, 20)};
  return run;
}

EventScore score_of(const KidnapRun& run) {
  const Result<Evaluation> e = evaluate(run.estimate, kidnapped_truth(), {}, run.context);
  EXPECT_TRUE(e.ok());
  EXPECT_EQ(e->events.size(), run.context.events.size());
  return e->events.front();
}

TEST(EventScores, AKidnapIsMeasuredFromTheEventToTheFirstLastingGoodScan) {
  const EventScore score = score_of(kidnap_run(23));
  EXPECT_NEAR(score.moved_m, 50, 0.01);
  EXPECT_NEAR(score.moved_deg, 1 / kDegree, 1e-6);
  ASSERT_TRUE(score.recovery_s);
  EXPECT_NEAR(*score.recovery_s, 3, 1e-9);
  ASSERT_TRUE(score.noticed_after_s);
  EXPECT_NEAR(*score.noticed_after_s, 0.4, 1e-9);
  EXPECT_EQ(score.misleading_scans, 4U) << "20.0 to 20.3 s";
  EXPECT_NEAR(score.worst_claim_m, 50, 0.01);
}

TEST(EventScores, ARelapseWithinTwoSecondsStartsTheClockAnew) {
  const auto relapse = [](double t, SE3&, std::string& status) {
    if (std::abs(t - 24.9) < 0.01) status = "DEGRADED";
  };
  const EventScore score = score_of(kidnap_run(23, relapse));
  ASSERT_TRUE(score.recovery_s);
  EXPECT_NEAR(*score.recovery_s, 5, 1e-9);
}

TEST(EventScores, ARelapseAfterTwoSecondsDoesNot) {
  const auto relapse = [](double t, SE3&, std::string& status) {
    if (t > 25.05 && t < 26) status = "DEGRADED";
  };
  EXPECT_NEAR(*score_of(kidnap_run(23, relapse)).recovery_s, 3, 1e-9);
}

TEST(EventScores, AWrongPoseInTrackingIsNoRecovery) {
  const auto wrong = [](double t, SE3& claim, std::string&) {
    if (t > 22.9 && t < 27.95) claim = claim * pose(0, 0.31);
  };
  EXPECT_NEAR(*score_of(kidnap_run(23, wrong)).recovery_s, 8, 1e-9);
}

TEST(EventScores, TwoSecondsThatTheRunDoesNotHaveAreNotAssumed) {
  EXPECT_TRUE(score_of(kidnap_run(38)).recovery_s) << "38.0 to 40.0 s are 2 s";
  EXPECT_FALSE(score_of(kidnap_run(38.1)).recovery_s);
}

/// Every second scan until `end`.
KidnapRun at_five_hertz(const KidnapRun& run, double end) {
  const auto kept = [end](TimeNs t) {
    return t <= from_seconds(end) && (t / (kSecond / 10)) % 2 == 0;
  };
  KidnapRun thin;
  thin.context.events = run.context.events;
  for (const StepRow& row : run.context.steps)
    if (kept(row.pose_time)) thin.context.steps.push_back(row);
  for (const StampedPose& p : run.estimate)
    if (kept(p.t)) thin.estimate.push_back(p);
  return thin;
}

TEST(EventScores, EighteenScansAreNeededHoweverLongTheyTake) {
  // Two seconds at 5 Hz hold 11 scans; the 18th comes 3.4 s after the first.
  EXPECT_FALSE(score_of(at_five_hertz(kidnap_run(23), 26.2)).recovery_s);
  EXPECT_TRUE(score_of(at_five_hertz(kidnap_run(23), 26.4)).recovery_s);
}

TEST(EventScores, ACarriedRobotIsTimedFromItsUncovering) {
  KidnapRun run = kidnap_run(27);
  run.context.events = {event_at("kidnap", 20, 25)};
  EXPECT_NEAR(*score_of(run).recovery_s, 2, 1e-9);
}

TEST(EventScores, ALastingChangeIsTimedFromItsStartAndAnOutageFromItsEnd) {
  const auto blind = [](double t, SE3&, std::string& status) {
    status = t > 9.95 && t < 12.95 ? "DEAD_RECKONING" : "TRACKING";
  };
  KidnapRun run = kidnap_run(20.4, blind);
  run.context.events = {event_at("blind", 10, 12)};
  EXPECT_NEAR(*score_of(run).recovery_s, 1, 1e-9);
  run.context.events = {event_at("imu_bias_jump", 10, 12)};
  EXPECT_NEAR(*score_of(run).recovery_s, 3, 1e-9);
}

TEST(EventScores, ARecoveryAfterTheNextKidnapBelongsToThatOne) {
  KidnapRun run = kidnap_run(23);
  run.context.events = {event_at("kidnap", 20, 20), event_at("kidnap", 22, 22)};
  const Result<Evaluation> e = evaluate(run.estimate, kidnapped_truth(), {}, run.context);
  ASSERT_TRUE(e.ok());
  EXPECT_FALSE(e->events[0].recovery_s);
  EXPECT_NEAR(*e->events[1].recovery_s, 1, 1e-9);
}

TEST(EventScores, EventsOfARunAreNotScoredAsIfTheyWereDoneToTheRobot) {
  KidnapRun run = kidnap_run(23);
  run.context.events = {event_at("status", 20, 20)};
  const Result<Evaluation> e = evaluate(run.estimate, kidnapped_truth(), {}, run.context);
  ASSERT_TRUE(e.ok());
  EXPECT_TRUE(e->events.empty());
  ASSERT_EQ(e->warnings.size(), 1U);
}

TEST(EventScores, ARelocalizationIsFalseWhenThePoseItAcceptedIsWrong) {
  const auto wrong = [](double t, SE3& claim, std::string&) {
    if (t > 22.9 && t < 24.95) claim = claim * pose(0, 0.6);
  };
  KidnapRun run = kidnap_run(23, wrong);
  run.context.run_events = {event_at("relocalized", 23, 23), event_at("relocalized", 25, 25)};
  const Result<Evaluation> e = evaluate(run.estimate, kidnapped_truth(), {}, run.context);
  ASSERT_TRUE(e.ok());
  ASSERT_EQ(e->relocalizations.size(), 2U);
  EXPECT_NEAR(e->relocalizations[0].trans_error_m, 0.6, 1e-9);
  EXPECT_EQ(e->false_relocalizations, 1U);
}

}  // namespace
}  // namespace holdfast::evaluation::testing
