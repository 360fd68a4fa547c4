#include "holdfast/relocalization/confirmation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace holdfast::relocalization {
namespace {

constexpr double kAccept = 0.99;

/// The robot `way_m` along its way from the start, in the odometry.
SE3 at(double way_m) { return {Eigen::Quaterniond::Identity(), {way_m, 0, 0}}; }

/// As seen from `T_odom_body`, if the odometry begins at `begin` in the map; `log_odds` is of it
/// against none of the candidates.
Candidate candidate(const SE3& begin, const SE3& T_odom_body, double log_odds) {
  Candidate c;
  c.T_map_body = begin * T_odom_body;
  c.log_odds = log_odds;
  c.weakest_sigma_m = 0.01;
  return c;
}

SearchReport report(std::vector<Candidate> candidates) {
  SearchReport r;
  r.outcome = SearchOutcome::kAmbiguous;
  double sum = 1.0;
  for (const Candidate& c : candidates) sum += std::exp(c.log_odds);
  for (Candidate& c : candidates) c.probability = std::exp(c.log_odds) / sum;
  r.candidates = std::move(candidates);
  return r;
}

const SE3 kHere = {so3::exp(Eigen::Vector3d(0, 0, 0.4)), {10, 20, 0}};
const SE3 kThere = {so3::exp(Eigen::Vector3d(0, 0, -2.0)), {40, 25, 0}};

TEST(Confirmation, OneStrongCandidateIsSureAtOnceAndAWeakOneIsNot) {
  Confirmation strong(kAccept);
  strong.hear(report({candidate(kHere, at(0), 8.0)}), at(0), 0);
  ASSERT_TRUE(strong.confirmed());
  EXPECT_LT((strong.confirmed()->candidate.T_map_body.translation - kHere.translation).norm(),
            1e-12);
  Confirmation weak(kAccept);
  weak.hear(report({candidate(kHere, at(0), 2.0)}), at(0), 0);
  EXPECT_FALSE(weak.confirmed());
}

TEST(Confirmation, TwoPlacesThatExplainTheSameAreNoAnswerHoweverFarTheRobotGoes) {
  Confirmation two(kAccept);
  for (int metre = 0; metre < 50; ++metre) {
    two.hear(report({candidate(kHere, at(metre), 6.0), candidate(kThere, at(metre), 6.0)}),
             at(metre), 1.0);
    EXPECT_FALSE(two.confirmed());
  }
}

TEST(Confirmation, TheWayTellsThePlaceThatFollowsTheOdometry) {
  Confirmation several(kAccept);
  int sure_at = -1;
  for (int metre = 0; metre < 10 && sure_at < 0; ++metre) {
    // Another place each time looks as good, as modes in a corridor do.
    const SE3 chance = {kThere.rotation, {40.0 + 3.0 * metre, 25, 0}};
    several.hear(report({candidate(kHere, at(metre), 2.5), candidate(chance, at(metre), 2.5)}),
                 at(metre), 1.0);
    if (several.confirmed()) sure_at = metre;
  }
  ASSERT_GT(sure_at, 1);
  EXPECT_LE(sure_at, 8);
  EXPECT_LT(
      (several.confirmed()->candidate.T_map_body.translation - kHere * at(sure_at).translation)
          .norm(),
      1e-12);
}

// A window of scans that was put together wrongly fits as badly each time.
TEST(Confirmation, PosesThatFitBadlyAreNotSureHoweverOftenTheyAreSeen) {
  Confirmation poor(kAccept);
  for (int metre = 0; metre < 20; ++metre) {
    poor.hear(report({candidate(kHere, at(metre), 1.5)}), at(metre), 1.0);
    EXPECT_FALSE(poor.confirmed());
  }
}

TEST(Confirmation, ARobotThatStandsDoesNotGrowSureOfAnything) {
  Confirmation standing(kAccept);
  for (int look = 0; look < 20; ++look) {
    standing.hear(report({candidate(kHere, at(0), 1.0)}), at(0), 0.1);
    EXPECT_FALSE(standing.confirmed());
  }
}

TEST(Confirmation, APoseThatTheLastSearchDidNotSeeIsNoAnswer) {
  Confirmation gone(kAccept);
  gone.hear(report({candidate(kHere, at(0), 10.0)}), at(0), 0);
  gone.hear(report({candidate(kThere, at(1), 1.0)}), at(1), 1);
  EXPECT_FALSE(gone.confirmed());
}

TEST(Confirmation, ADirectionThatIsNotDeterminedIsNoAnswer) {
  Confirmation open(kAccept);
  Candidate along = candidate(kHere, at(0), 10.0);
  along.weakest_sigma_m = 5.0;
  open.hear(report({along}), at(0), 0);
  EXPECT_FALSE(open.confirmed());
}

TEST(Confirmation, ALateComerIsBehindByTheSearchesThatDidNotSeeIt) {
  Confirmation late(kAccept);
  late.hear(report({candidate(kHere, at(0), 3.0)}), at(0), 0);
  late.hear(report({candidate(kHere, at(2), 3.0)}), at(2), 2);
  late.hear(report({candidate(kHere, at(4), 3.0), candidate(kThere, at(4), 3.5)}), at(4), 2);
  ASSERT_TRUE(late.confirmed());
  EXPECT_LT((late.confirmed()->candidate.T_map_body.translation - kHere * at(4).translation).norm(),
            1e-9);
}

TEST(Confirmation, AfterAResetNothingStands) {
  Confirmation again(kAccept);
  again.hear(report({candidate(kHere, at(0), 10.0)}), at(0), 0);
  again.reset();
  EXPECT_FALSE(again.confirmed());
  EXPECT_EQ(again.standing(), 0U);
}

}  // namespace
}  // namespace holdfast::relocalization
