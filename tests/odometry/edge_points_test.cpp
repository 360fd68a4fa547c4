#include "holdfast/odometry/edges/edge_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace holdfast::odometry {
namespace {

using Eigen::Vector3d;

constexpr int kColumns = 1800;

/// What a sensor of `rings` beams sees of a square pillar of 1 m at 3 m, in front of a wall at 8 m.
Scan pillar(int rings, bool own_body = false) {
  Scan scan;
  scan.end_time = kSecond / 10;
  scan.has_ring = true;
  for (int ring = 0; ring < rings; ++ring) {
    const double rise = std::tan((ring - 0.5 * rings) * 0.4 / rings);
    for (int column = 0; column < kColumns / 4; ++column) {
      const double angle = 2 * std::numbers::pi * (column - kColumns / 8) / kColumns;
      const double side = std::tan(angle);
      double x = 8;
      if (std::abs(3 * side) < 0.5) x = 3;
      if (own_body && std::abs(side) > 0.9) x = 0.3;
      ScanPoint p;
      p.x = static_cast<float>(x);
      p.y = static_cast<float>(x * side);
      p.z = static_cast<float>(x * rise / std::cos(angle));
      p.ring = static_cast<std::uint16_t>(ring);
      scan.points.push_back(p);
    }
  }
  return scan;
}

TEST(EdgeFinder, APillarHasTwoUprightEdges) {
  EdgeFinder finder(0.02);
  std::vector<SeenEdge> edges;
  finder.find(pillar(16), 0.7, 100, edges);
  ASSERT_GE(edges.size(), 20U);
  for (const SeenEdge& edge : edges) {
    EXPECT_NEAR(edge.point.x, 3.0, 0.02);
    // Half a spacing beyond the last ray that hit: the spacing is 1 cm.
    EXPECT_NEAR(std::abs(edge.point.y), 0.5, 0.008);
    EXPECT_GT(std::abs(edge.axis.z()), 0.99);
  }
}

TEST(EdgeFinder, TheRobotItselfHasNone) {
  EdgeFinder finder(0.02);
  std::vector<SeenEdge> edges;
  finder.find(pillar(16, true), 0.7, 100, edges);
  for (const SeenEdge& edge : edges) EXPECT_GT(edge.point.x, 2.0);
}

TEST(EdgeFinder, OfManyBeamsSomeAreEnough) {
  EdgeFinder finder(0.02);
  std::vector<SeenEdge> few, many;
  finder.find(pillar(64), 0.7, 100, few);
  finder.find(pillar(256), 0.7, 100, many);
  ASSERT_GE(few.size(), 100U);
  // 115 200 points: one ring of four.
  EXPECT_NEAR(static_cast<double>(many.size()), static_cast<double>(few.size()), 8.0);
}

TEST(PutEdges, MovesAnEdgeAsTheBodyWent) {
  const Scan scan = pillar(16);
  filter::SelectedScan selected;
  selected.scan = &scan;
  selected.imu.samples = {{0, Vector3d::Zero(), Vector3d(0, 0, 9.81)},
                          {scan.end_time, Vector3d::Zero(), Vector3d(0, 0, 9.81)}};
  SeenEdge edge;
  edge.point.x = 3;  // seen at the beginning of the scan
  edge.axis = Eigen::Vector3f::UnitZ();
  filter::MatchState x;
  x.gravity_map = {0, 0, -9.81};
  x.v_map = {2, 0, 0};
  x.T_map_body.translation = {100, 0, 0};  // of no account
  const auto put = put_edges({edge}, selected, x);
  ASSERT_EQ(put.size(), 1U);
  EXPECT_NEAR(put[0].position.x(), 3 - 0.2, 1e-3);
  EXPECT_NEAR(put[0].direction.z(), 1, 1e-5);
}

}  // namespace
}  // namespace holdfast::odometry
