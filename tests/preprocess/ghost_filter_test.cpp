#include "holdfast/preprocess/ghost_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "holdfast/core/random.hpp"

namespace holdfast::preprocess {
namespace {

constexpr int kColumns = 1800;
constexpr int kRings = 16;
constexpr double kStep = 2 * M_PI / kColumns;

/// Range by column and ring; a column is 0.2 degrees, a ring 2.
using Ranges = std::function<double(int, int)>;

Scan scan_of(const Ranges& range, double sigma = 0.02) {
  RandomStream random(1, "ranges");
  Scan scan;
  scan.has_ring = true;
  for (int column = 0; column < kColumns; ++column) {
    for (int ring = 0; ring < kRings; ++ring) {
      const double azimuth = kStep * column;
      const double elevation = (2 * ring - 15) * M_PI / 180;
      const double r = range(column, ring) + random.normal(0, sigma);
      scan.points.push_back({static_cast<float>(r * std::cos(elevation) * std::cos(azimuth)),
                             static_cast<float>(r * std::cos(elevation) * std::sin(azimuth)),
                             static_cast<float>(r * std::sin(elevation)), 0, column,
                             static_cast<std::uint16_t>(ring)});
    }
  }
  return scan;
}

GhostFilterConfig both() {
  GhostFilterConfig config;
  config.mixed_pixels = config.ghosts = true;
  return config;
}

GhostCounts apply(Scan& scan, const GhostFilterConfig& config = both()) {
  return GhostFilter(config).apply(scan);
}

/// Something at 4 m in columns 100 to 199 in front of a wall at 10 m.
double screen(int column, int) { return column >= 100 && column < 200 ? 4.0 : 10.0; }

TEST(GhostFilter, IsOffByDefault) {
  Scan scan = scan_of([](int c, int r) { return c == 200 ? 5.0 + 0.3 * r : screen(c, r); });
  const GhostCounts counts = apply(scan, {});
  EXPECT_EQ(counts.mixed_pixels + counts.ghosts, 0U);
  EXPECT_EQ(scan.points.size(), std::size_t{kColumns * kRings});
}

/// One column past the screen's end meets both, in parts that differ from ring to ring: 4.4 m to
/// 8.6 m by steps of 0.28 m.
TEST(GhostFilter, DropsMixedPixelsAndNothingElse) {
  const auto mixed = [](int c, int r) { return c == 200 ? 4.4 + 0.28 * r : screen(c, r); };
  Scan scan = scan_of(mixed);
  const GhostCounts counts = apply(scan);
  EXPECT_EQ(counts.mixed_pixels, std::size_t{kRings});
  EXPECT_EQ(counts.ghosts, 0U);
  EXPECT_EQ(scan.points.size(), std::size_t{(kColumns - 1) * kRings});
  for (const ScanPoint& p : scan.points) ASSERT_NE(p.time_offset_ns, 200);
}

TEST(GhostFilter, TheEndsOfAScreenStayWhole) {
  Scan scan = scan_of(screen);
  const GhostCounts counts = apply(scan);
  EXPECT_EQ(counts.mixed_pixels + counts.ghosts, 0U);
}

/// One ray wide, in front of everything.
TEST(GhostFilter, AWireInFrontOfAWallStays) {
  Scan scan = scan_of([](int c, int) { return c == 500 ? 3.0 : 10.0; });
  EXPECT_EQ(apply(scan).mixed_pixels, 0U);
}

/// One ray wide, at 7 m between the screen at 4 m and the wall at 10 m: by its ring alone it is a
/// mixed pixel, but the rings above and below see it too.
TEST(GhostFilter, APoleBetweenAScreenAndAWallStays) {
  Scan scan = scan_of([](int c, int r) { return c == 200 ? 7.0 : screen(c, r); });
  EXPECT_EQ(apply(scan).mixed_pixels, 0U);
}

/// The steps of a stair or the boards of a shelf are as deep as the limit and wider than a ray.
TEST(GhostFilter, StairsStay) {
  Scan scan = scan_of([](int c, int) { return 4.0 + 0.3 * (c / 2 % 20); });
  EXPECT_EQ(apply(scan).mixed_pixels, 0U);
}

TEST(GhostFilter, AWallSeenAtGrazingIncidenceStays) {
  // y = 1.5 m, up to 60 m away: neighbours are up to 8 m apart.
  const auto wall = [](int c, int) {
    return std::min(60.0, 1.5 / std::max(std::abs(std::sin(kStep * c)), 1e-3));
  };
  Scan scan = scan_of(wall);
  EXPECT_EQ(apply(scan).mixed_pixels, 0U);
}

/// A polished floor shows the lamp above it as if it were below.
TEST(GhostFilter, DropsALoneReturnFromBehindASurface) {
  Scan scan = scan_of([](int c, int r) { return c == 700 && r == 3 ? 9.0 : 5.0; });
  const GhostCounts counts = apply(scan);
  EXPECT_EQ(counts.ghosts, 1U);
  EXPECT_EQ(counts.mixed_pixels, 0U);
}

TEST(GhostFilter, TheViewThroughAWindowOrASlitStays) {
  Scan window = scan_of([](int c, int) { return c >= 700 && c < 720 ? 9.0 : 5.0; });
  EXPECT_EQ(apply(window).ghosts, 0U);
  Scan slit = scan_of([](int c, int) { return c == 700 ? 9.0 : 5.0; });
  EXPECT_EQ(apply(slit).ghosts, 0U);
}

TEST(GhostFilter, RaysTooFarApartToShareASpotSayNothing) {
  GhostFilterConfig config = both();
  config.spot_mrad = 1e3 * kStep / 2;
  Scan scan = scan_of([](int c, int r) { return c == 200 ? 4.4 + 0.28 * r : screen(c, r); });
  EXPECT_EQ(apply(scan, config).mixed_pixels, 0U);
}

TEST(GhostFilter, WithoutRingsOrPointsNothingHappens) {
  Scan scan = scan_of([](int c, int r) { return c == 200 ? 4.4 + 0.28 * r : screen(c, r); });
  scan.has_ring = false;
  EXPECT_EQ(apply(scan).mixed_pixels, 0U);
  Scan empty;
  empty.has_ring = true;
  EXPECT_EQ(apply(empty).mixed_pixels, 0U);
}

}  // namespace
}  // namespace holdfast::preprocess
