#include "holdfast/features/scan_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/features/ray_scene.hpp"

namespace holdfast::features {
namespace {

using namespace testing;

double elevation(const Vector3f& p) { return std::asin(p.z() / p.norm()); }

void expect_every_point_once(const ScanRows& rows, std::size_t n) {
  ASSERT_EQ(rows.size(), n);
  std::vector<std::uint32_t> sources = rows.source;
  std::sort(sources.begin(), sources.end());
  for (std::uint32_t i = 0; i < n; ++i) ASSERT_EQ(sources[i], i);
}

/// Largest spread of elevation in a row.
double thickest_row(const ScanRows& rows) {
  double most = 0;
  for (std::size_t r = 0; r < rows.rows(); ++r) {
    double low = 10, high = -10;
    for (std::uint32_t i = rows.begin[r]; i < rows.begin[r + 1]; ++i) {
      low = std::min(low, elevation(rows.points[i]));
      high = std::max(high, elevation(rows.points[i]));
    }
    most = std::max(most, high - low);
  }
  return most;
}

/// Share of neighbours in a row whose azimuth goes the usual way.
double share_in_order(const ScanRows& rows) {
  double right = 0, all = 0;
  for (std::size_t r = 0; r < rows.rows(); ++r) {
    for (std::uint32_t i = rows.begin[r]; i + 1 < rows.begin[r + 1]; ++i) {
      const Vector3f &p = rows.points[i], &q = rows.points[i + 1];
      right += p.x() * q.y() - p.y() * q.x() > 0;
      ++all;
    }
  }
  return std::max(right, all - right) / all;
}

TEST(ScanRows, FollowTheRingsOfTheSensorInTheOrderOfTheLog) {
  const Scan scan = room().scan(1);
  RowSorter sorter;
  ScanRows rows;
  sorter.sort(scan, rows);
  ASSERT_EQ(rows.rows(), 16U);
  expect_every_point_once(rows, scan.points.size());
  for (std::size_t r = 0; r < 16; ++r) {
    for (std::uint32_t i = rows.begin[r]; i < rows.begin[r + 1]; ++i) {
      ASSERT_EQ(scan.points[rows.source[i]].ring, r);
      ASSERT_EQ(point_of(scan.points[rows.source[i]]), rows.points[i]);
      if (i > rows.begin[r]) {
        ASSERT_LT(rows.source[i - 1], rows.source[i]);
      }
    }
  }
}

TEST(ScanRows, WithoutRingsBeamsAreToldApartByTheirElevation) {
  Scan scan = room().scan(1);
  scan.has_ring = false;
  RowSorter sorter;
  ScanRows rows;
  sorter.sort(scan, rows);
  ASSERT_EQ(rows.rows(), 16U);
  expect_every_point_once(rows, scan.points.size());
  EXPECT_LT(thickest_row(rows), 1e-5);
  EXPECT_LT(elevation(rows.points.front()), elevation(rows.points.back()));
  EXPECT_GT(share_in_order(rows), 0.99);
}

/// As KITTI's files hold them: ring after ring, the highest first, with elevations that waver.
TEST(ScanRows, WithoutRingsALogOfTurnsIsSplitWhereTheElevationJumps) {
  const Scan by_column = room().scan(1);
  RandomStream random(1, "waver");
  std::vector<Vector3f> points;
  for (int ring = 15; ring >= 0; --ring) {
    for (const ScanPoint& p : by_column.points) {
      if (p.ring != ring) continue;
      const auto waver = static_cast<float>(random.normal(0, 0.002));
      points.push_back(point_of(p) + Vector3f(0, 0, waver * point_of(p).norm()));
    }
  }
  RowSorter sorter;
  ScanRows rows;
  sorter.sort(points, {}, rows);
  ASSERT_EQ(rows.rows(), 16U);
  expect_every_point_once(rows, points.size());
  EXPECT_LT(thickest_row(rows), 0.02);
  EXPECT_LT(elevation(rows.points.front()), elevation(rows.points.back()));
}

/// No beams at all: a pattern that never repeats.
TEST(ScanRows, WithoutBeamsAreThoseOfAGridOfElevations) {
  RandomStream random(1, "rosette");
  std::vector<Vector3f> points;
  for (int i = 0; i < 20000; ++i) {
    const double azimuth = random.uniform(-0.6, 0.6);
    const double height = random.uniform(-0.4, 0.4);
    const Vector3d ray(std::cos(azimuth), std::sin(azimuth), height);
    points.push_back((5.0 * ray).cast<float>());
  }
  RowSorter sorter;
  ScanRows rows;
  sorter.sort(points, {}, rows);
  expect_every_point_once(rows, points.size());
  EXPECT_GT(rows.rows(), 20U);
  EXPECT_LT(thickest_row(rows), 0.05);
  EXPECT_GT(share_in_order(rows), 0.85);  // bins of azimuth are 0.04 degrees wide
}

TEST(ScanRows, OfNothingAreNone) {
  RowSorter sorter;
  ScanRows rows;
  sorter.sort(room().scan(1), rows);
  sorter.sort(Scan{}, rows);
  EXPECT_EQ(rows.rows(), 0U);
  EXPECT_EQ(rows.size(), 0U);
  sorter.sort({Vector3f(1, 2, 3)}, {}, rows);
  EXPECT_EQ(rows.size(), 1U);
}

}  // namespace
}  // namespace holdfast::features
