#include "holdfast/odometry/edges/edge_ways.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "holdfast/core/random.hpp"

namespace holdfast::odometry {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Door frames on both sides of a corridor along x: upright edges at uneven places, each seen by
/// five beams, from a sensor at `x`.
std::vector<EdgePoint> frames_seen_from(double x, std::uint64_t seed) {
  RandomStream places(1, "places");
  RandomStream noise(seed, "noise");
  std::vector<EdgePoint> edges;
  for (int frame = 0; frame < 12; ++frame) {
    const double place = places.uniform(-12, 12);
    const double side = frame % 2 == 0 ? 1.0 : -1.0;
    for (int beam = 0; beam < 5; ++beam) {
      const Vector3d p(place - x + 0.01 * noise.normal(), side + 0.01 * noise.normal(),
                       0.3 * beam - 0.6);
      edges.push_back({p.cast<float>(), Vector3f::UnitZ(), 0.01F});
    }
  }
  return edges;
}

TEST(EdgeWays, FramesAlongACorridorTellTheWayThatTheWallsDoNot) {
  for (const double way : {0.0, 0.12, 0.55, 1.3}) {
    const EdgeWays edges(frames_seen_from(0, 2), frames_seen_from(way, 3));
    const auto votes = edges.votes(1.5, 3);
    ASSERT_FALSE(votes.empty()) << way;
    // A cell of 0.1 m and its neighbours.
    EXPECT_LT((votes[0] - Vector3d(way, 0, 0)).norm(), 0.15) << way;
    Vector3d best = votes[0];
    for (int i = 0; i < 4; ++i) {
      const auto fit = edges.fit(best);
      best.head<2>() -= fit.H.topLeftCorner<2, 2>().inverse() * fit.g.head<2>();
    }
    // 60 edges of 1 cm, seen twice: 1.4 cm / sqrt(60) for each axis, 4 sigmas.
    EXPECT_LT((best - Vector3d(way, 0, 0)).norm(), 0.008) << way;
    // Where it is, and not half a metre on.
    EXPECT_LT(edges.fit({way, 0, 0}).cost + 200, edges.fit({way + 0.5, 0, 0}).cost) << way;
  }
}

TEST(EdgeWays, TheGradientIsThatOfTheCost) {
  const EdgeWays edges(frames_seen_from(0, 2), frames_seen_from(0.1, 3));
  const Vector3d at(0.11, 0.005, 0);
  constexpr double kStep = 1e-4;
  for (int axis = 0; axis < 2; ++axis) {
    Vector3d step = Vector3d::Zero();
    step[axis] = kStep;
    const double slope = (edges.fit(at + step).cost - edges.fit(at - step).cost) / (2 * kStep);
    const double gradient = 2 * edges.fit(at).g[axis];
    EXPECT_NEAR(slope, gradient, 0.02 * std::abs(gradient) + 1.0) << axis;
  }
}

TEST(EdgeWays, AnEdgeTellsNothingAlongItself) {
  const EdgeWays edges(frames_seen_from(0, 2), frames_seen_from(0, 3));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(edges.fit(Vector3d::Zero()).H);
  EXPECT_LT(solver.eigenvalues()[0], 1e-6 * solver.eigenvalues()[2]);
  EXPECT_NEAR(std::abs(solver.eigenvectors().col(0).z()), 1, 1e-6);
}

TEST(EdgeWays, WithoutEdgesThereIsNoVoteAndNoCost) {
  const EdgeWays none({}, {});
  EXPECT_TRUE(none.votes(1.5, 3).empty());
  EXPECT_EQ(none.fit(Vector3d::Zero()).cost, 0);
  // What has no partner costs as much wherever it is.
  const EdgeWays alone({}, frames_seen_from(0, 2));
  EXPECT_EQ(alone.fit(Vector3d::Zero()).cost, 60 * 9.0);
  EXPECT_EQ(alone.fit({1, 0, 0}).cost, 60 * 9.0);
}

}  // namespace
}  // namespace holdfast::odometry
