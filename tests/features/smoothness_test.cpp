#include "holdfast/features/smoothness.hpp"

#include <gtest/gtest.h>

#include "tests/features/ray_scene.hpp"
#include "tests/tolerances.hpp"

namespace holdfast::features {
namespace {

using namespace testing;

/// One row of points `spacing` apart on a line, then one that lies `off` to the side.
ScanRows row_with_one_off(int n, float spacing, float off) {
  ScanRows rows;
  for (int i = 0; i < n; ++i) {
    rows.points.push_back({spacing * static_cast<float>(i), i == n / 2 ? off : 0.0F, 4.0F});
    rows.source.push_back(static_cast<std::uint32_t>(2 * i));
  }
  rows.begin = {0, static_cast<std::uint32_t>(n)};
  return rows;
}

struct Classified {
  SmoothnessStatistics statistics;
  std::vector<double> s;
  Features features;
};

Classified classify(const ScanRows& rows, bool logarithmic) {
  Classified c;
  c.statistics = classify_by_smoothness(rows, FeatureConfig{}, logarithmic, c.s, c.features);
  return c;
}

/// s = (4 + 1 + 1 + 4) d^2 / 5.
TEST(Smoothness, OnAStraightLineIsTwiceTheSquareOfTheSpacing) {
  const Classified c = classify(row_with_one_off(50, 0.25F, 0.0F), false);
  EXPECT_EQ(c.statistics.count, 46U);
  EXPECT_EQ(c.statistics.mean, 2 * 0.25 * 0.25);  // powers of two: exact
  EXPECT_EQ(c.statistics.sigma, 0);
  EXPECT_TRUE(std::isnan(c.s[1]) && std::isnan(c.s[48]));
}

/// Of 100 points one is 1 m off: its s grows by 4/5, those of its four neighbours by 1/5. The mean
/// grows by 1.6 / 96 and 1.5 sigma is 0.13, so that all five are above it.
TEST(Smoothness, PointsAboveTheThresholdAreEdgesAndNameTheirSource) {
  const Classified c = classify(row_with_one_off(100, 0.25F, 1.0F), false);
  ASSERT_EQ(c.features.edges.size(), 5U);
  EXPECT_EQ(c.features.edges[2].index, 100U);
  EXPECT_TRUE(c.features.planes.empty());
}

TEST(Smoothness, NeighboursAreThoseOfTheSameRow) {
  ScanRows rows = row_with_one_off(40, 0.25F, 0.0F);
  for (int i = 20; i < 40; ++i) rows.points[i].y() += 100.0F;
  rows.begin = {0, 20, 40};
  const Classified c = classify(rows, false);
  EXPECT_EQ(c.statistics.count, 32U);
  EXPECT_EQ(c.statistics.sigma, 0);
}

/// The print: s is heavy-tailed, mu - sigma is negative.
TEST(Smoothness, AsPrintedFindsNoPlaneInAFurnishedRoom) {
  RowSorter sorter;
  ScanRows rows;
  sorter.sort(furnished_room().scan(1), rows);
  const Classified c = classify(rows, false);
  EXPECT_LT(c.statistics.mean, c.statistics.sigma);
  EXPECT_TRUE(c.features.planes.empty());
  EXPECT_FALSE(c.features.edges.empty());
}

/// Chebyshev's inequality bounds both shares: 1 / (1 + k^2) on one side.
TEST(Smoothness, ItsLogarithmFindsBoth) {
  RowSorter sorter;
  ScanRows rows;
  sorter.sort(furnished_room().scan(1), rows);
  const Classified c = classify(rows, true);
  const auto n = static_cast<double>(c.statistics.count);
  EXPECT_GT(c.features.planes.size(), 0.05 * n);
  EXPECT_LT(c.features.planes.size(), 0.5 * n);
  EXPECT_GT(c.features.edges.size(), 0.01 * n);
  EXPECT_LT(c.features.edges.size(), n / (1 + 1.5 * 1.5));
}

TEST(Smoothness, PointsThatCoincideHaveNoLogarithm) {
  const Classified c = classify(row_with_one_off(20, 0.0F, 0.0F), true);
  EXPECT_EQ(c.statistics.count, 0U);
  EXPECT_TRUE(c.features.planes.empty() && c.features.edges.empty());
}

}  // namespace
}  // namespace holdfast::features
