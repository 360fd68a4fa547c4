#include "evaluation/truth_track.hpp"

#include "tests/evaluation/scenes.hpp"

namespace holdfast::evaluation::testing {
namespace {

constexpr TimeNs kMs = kSecond / 1000;

TEST(TruthTrack, BetweenTwoLinesThePoseIsInterpolated) {
  const TruthTrack truth({{0, pose(1, 2, 3, 0)}, {100 * kMs, pose(2, 0, 3, 0.4)}});
  const TruthSample sample = truth.at(25 * kMs);
  ASSERT_TRUE(sample.known());
  EXPECT_NEAR(sample.T_map_body.translation.x(), 1.25, kPositionRounding);
  EXPECT_NEAR(sample.T_map_body.translation.y(), 1.5, kPositionRounding);
  EXPECT_NEAR(so3::log(sample.T_map_body.rotation).z(), 0.1, kPositionRounding);
}

TEST(TruthTrack, OutsideOfItsTimeNothingIsKnown) {
  const TruthTrack truth({{0, pose(0)}, {10 * kMs, pose(1)}});
  EXPECT_EQ(truth.at(-1).kind, TruthSample::Kind::kOutside);
  EXPECT_EQ(truth.at(10 * kMs + 1).kind, TruthSample::Kind::kOutside);
  EXPECT_TRUE(truth.at(0).known());
  EXPECT_TRUE(truth.at(10 * kMs).known());
  EXPECT_EQ(TruthTrack({}).at(0).kind, TruthSample::Kind::kOutside);
}

TEST(TruthTrack, NothingIsInterpolatedAcrossATeleport) {
  const TruthTrack truth(
      {{0, pose(0)}, {10 * kMs, pose(1)}, {10 * kMs, pose(50)}, {20 * kMs, pose(51)}});
  EXPECT_NEAR(truth.at(9 * kMs).T_map_body.translation.x(), 0.9, kPositionRounding);
  EXPECT_NEAR(truth.at(10 * kMs).T_map_body.translation.x(), 50, kPositionRounding);
  EXPECT_NEAR(truth.at(11 * kMs).T_map_body.translation.x(), 50.1, kPositionRounding);
  EXPECT_NE(truth.at(9 * kMs).stretch, truth.at(11 * kMs).stretch);
  EXPECT_NEAR(truth.length_m(), 2, kPositionRounding) << "the jump is no way";
}

TEST(TruthTrack, NothingIsInterpolatedAcrossAGap) {
  Trajectory poses = sample(0, 1, 100, straight);
  const Trajectory later = sample(1.2, 2, 100, straight);
  poses.insert(poses.end(), later.begin(), later.end());
  const TruthTrack truth(poses, 0.1);
  EXPECT_EQ(truth.at(from_seconds(1.1)).kind, TruthSample::Kind::kGap);
  EXPECT_TRUE(truth.at(from_seconds(1.2)).known());
  EXPECT_EQ(truth.at(from_seconds(1.5)).stretch, truth.at(from_seconds(0.5)).stretch + 1);
}

TEST(TruthTrack, ASlowTruthIsInterpolatedToATenthHertzButNotToOne) {
  EXPECT_TRUE(TruthTrack(sample(0, 10, 8, straight)).at(from_seconds(5.06)).known());
  EXPECT_EQ(TruthTrack(sample(0, 10, 1, straight)).at(from_seconds(5.06)).kind,
            TruthSample::Kind::kGap);
}

TEST(TruthTrack, NoiseAtRestIsNoWay) {
  const auto trembling = [](double t) { return pose(0.004 * std::sin(1e3 * t)); };
  EXPECT_NEAR(TruthTrack(truth_of(10, trembling)).length_m(), 0, kPositionRounding);
}

}  // namespace
}  // namespace holdfast::evaluation::testing
