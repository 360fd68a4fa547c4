#include "holdfast/preprocess/scan_selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace holdfast::preprocess {
namespace {

constexpr int kBeams = 16;
constexpr int kColumns = 1800;

/// A revolution of a 16-beam LiDAR in the order of firing, every return at 10 m.
Scan revolution() {
  Scan scan;
  scan.has_ring = true;
  for (int column = 0; column < kColumns; ++column) {
    const double azimuth = 2 * M_PI * column / kColumns;
    for (int beam = 0; beam < kBeams; ++beam) {
      const double elevation = (beam - 7.5) * M_PI / 90;
      ScanPoint p;
      p.x = static_cast<float>(10 * std::cos(elevation) * std::cos(azimuth));
      p.y = static_cast<float>(-10 * std::cos(elevation) * std::sin(azimuth));
      p.z = static_cast<float>(10 * std::sin(elevation));
      p.ring = static_cast<std::uint16_t>(beam);
      scan.points.push_back(p);
    }
  }
  return scan;
}

Scan points_at(const std::vector<float>& ranges) {
  Scan scan;
  for (const float range : ranges) {
    ScanPoint p;
    p.y = -range;
    scan.points.push_back(p);
  }
  return scan;
}

ScanSelectionConfig most(int points) {
  ScanSelectionConfig config;
  config.max_points = points;
  config.least_share = 0;
  return config;
}

TEST(SelectPoints, ALeastShareOfALargeScanIsTakenThoughItBeMoreThanTheMost) {
  ScanSelectionConfig config = most(100);
  config.least_share = 0.25;
  std::vector<std::uint32_t> selected;
  EXPECT_EQ(select_points(points_at(std::vector<float>(1000, 5.0F)), config, 0, selected), 1000U);
  EXPECT_EQ(selected.size(), 250U);
  select_points(points_at(std::vector<float>(200, 5.0F)), config, 0, selected);
  EXPECT_EQ(selected.size(), 100U);
}

TEST(SelectPoints, KeepsExactlyWhatLiesWithinTheLimitsOfRange) {
  ScanSelectionConfig config;
  config.min_range_m = 1.0;
  config.max_range_m = 50.0;
  std::vector<std::uint32_t> selected = {7, 7, 7};
  const Scan scan = points_at({0.0F, 0.999F, 1.0F, 20.0F, 50.0F, 50.01F, 3.0F});
  EXPECT_EQ(select_points(scan, config, 0, selected), 4U);
  EXPECT_EQ(selected, (std::vector<std::uint32_t>{2, 3, 4, 6}));
}

TEST(SelectPoints, AnEmptyScanGivesNothing) {
  std::vector<std::uint32_t> selected = {1, 2};
  EXPECT_EQ(select_points(Scan{}, ScanSelectionConfig{}, 0, selected), 0U);
  EXPECT_TRUE(selected.empty());
}

TEST(SelectPoints, AScanWithinTheNumberIsTakenWhole) {
  const Scan scan = points_at(std::vector<float>(500, 5.0F));
  std::vector<std::uint32_t> selected;
  EXPECT_EQ(select_points(scan, most(500), 3, selected), 500U);
  ASSERT_EQ(selected.size(), 500U);
  for (std::uint32_t i = 0; i < 500; ++i) EXPECT_EQ(selected[i], i);
}

class ThinnedTo : public ::testing::TestWithParam<int> {};

TEST_P(ThinnedTo, ExactlyThatManyDifferentPointsInAscendingOrder) {
  const Scan scan = revolution();
  std::vector<std::uint32_t> selected;
  EXPECT_EQ(select_points(scan, most(GetParam()), 5, selected), scan.points.size());
  ASSERT_EQ(selected.size(), static_cast<std::size_t>(GetParam()));
  for (std::size_t i = 1; i < selected.size(); ++i) ASSERT_LT(selected[i - 1], selected[i]);
  EXPECT_LT(selected.back(), scan.points.size());
}

TEST_P(ThinnedTo, EveryRingGetsItsShare) {
  const Scan scan = revolution();
  const double expected = static_cast<double>(GetParam()) / kBeams;
  // At most as uneven as drawing each point alone: 5 standard deviations of a binomial count.
  const double bound = 5 * std::sqrt(expected * (1 - 1.0 / kBeams));
  for (std::uint64_t number = 0; number < 20; ++number) {
    std::vector<std::uint32_t> selected;
    select_points(scan, most(GetParam()), number, selected);
    std::vector<int> count(kBeams, 0);
    for (const std::uint32_t i : selected) ++count[scan.points[i].ring];
    for (int ring = 0; ring < kBeams; ++ring) {
      EXPECT_NEAR(count[static_cast<std::size_t>(ring)], expected, bound)
          << "ring " << ring << " of scan " << number;
    }
  }
}

TEST_P(ThinnedTo, EverySectorGetsItsShare) {
  const Scan scan = revolution();
  std::vector<std::uint32_t> selected;
  select_points(scan, most(GetParam()), 1, selected);
  constexpr int kSectors = 12;
  std::vector<int> count(kSectors, 0);
  for (const std::uint32_t i : selected) {
    ++count[i * kSectors / scan.points.size()];
  }
  // One point of each run of neighbours: a sector's border cuts at most one run at each end.
  for (const int n : count) EXPECT_NEAR(n, GetParam() / static_cast<double>(kSectors), 2.0);
}

// 16 beams against runs of 32, 16, 8, 3.6 and 1.03 neighbours.
INSTANTIATE_TEST_SUITE_P(Points, ThinnedTo, ::testing::Values(900, 1800, 3600, 8000, 28000));

TEST(SelectPoints, TheSameNumberOfScanGivesTheSameChoice) {
  const Scan scan = revolution();
  std::vector<std::uint32_t> once, again;
  select_points(scan, most(1800), 41, once);
  select_points(scan, most(1800), 41, again);
  EXPECT_EQ(once, again);
}

TEST(SelectPoints, SuccessiveScansLookAtDifferentPoints) {
  const Scan scan = revolution();
  std::set<std::uint32_t> seen;
  constexpr int kScans = 8;
  constexpr int kRuns = 1800;
  for (std::uint64_t number = 0; number < kScans; ++number) {
    std::vector<std::uint32_t> selected;
    select_points(scan, most(kRuns), number, selected);
    seen.insert(selected.begin(), selected.end());
  }
  // Of 16 places in a run, 8 draws see 16 (1 - (15/16)^8) = 6.45 on average, with a standard
  // deviation below 1 a run.
  const double expected = kRuns * 16 * (1 - std::pow(15.0 / 16, kScans));
  EXPECT_NEAR(static_cast<double>(seen.size()), expected, 5 * std::sqrt(kRuns));
}

}  // namespace
}  // namespace holdfast::preprocess
