#include "holdfast/relocalization/wide/wide_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "holdfast/core/random.hpp"

namespace holdfast::relocalization {
namespace {

using Eigen::Vector3f;

std::vector<Vector3f> cloud(std::size_t count, float high) {
  RandomStream random(3, "cells");
  const auto draw = [&](double most) { return static_cast<float>(random.uniform(0, most)); };
  std::vector<Vector3f> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(draw(20) - 10, draw(20) - 10, draw(static_cast<double>(high)));
  }
  return points;
}

/// All standpoints within 6 m of the middle.
std::vector<places::Place> middle_place() {
  places::Place place{};
  place.position = {0, 0, 1};
  place.weakest = {1, 0, 0};
  return {place};
}

/// Hits by definition, one point after the other.
int hits(const OccupancyPyramid& map, const std::vector<Vector3f>& points, const Cell& at,
         double yaw) {
  const Eigen::Matrix3f R =
      Eigen::AngleAxisf(static_cast<float>(yaw), Vector3f::UnitZ()).toRotationMatrix();
  int count = 0;
  for (const Vector3f& point : points) {
    const Vector3f p = R * point / kCellM + Vector3f::Constant(0.5F);
    const Cell cell{at.x + static_cast<int>(std::floor(p.x())),
                    at.y + static_cast<int>(std::floor(p.y())),
                    at.z + static_cast<int>(std::floor(p.z()))};
    count += map.occupied(cell) ? 1 : 0;
  }
  return count;
}

class WideSearchOf : public testing::TestWithParam<float> {};

TEST_P(WideSearchOf, FindsTheBestModeThatTryingAllFinds) {
  const OccupancyPyramid map(cloud(3000, GetParam()), 0, 40);
  const Standpoints standpoints(middle_place(), map, {});
  std::vector<Vector3f> seen = cloud(60, 4);
  constexpr int kYaws = 12;
  std::vector<int> lane_z;
  for (int w = 0; w < standpoints.words(); ++w) lane_z.push_back(standpoints.low_z(w));
  const TurnedPoints turned(seen, kYaws, Eigen::Quaternionf::Identity(), map, lane_z);
  WideOptions options;
  options.least_share = 0;
  const WideResult found = WideSearch(map, standpoints, turned, options).run(seen.size());

  int best = 0;
  for (int yaw = 0; yaw < kYaws; ++yaw) {
    for (int y = -14; y < 14; ++y) {
      for (int x = -14; x < 14; ++x) {
        const std::uint64_t lanes = standpoints.lanes(0, x, y, 0);
        for (int lane = 0; lane < kLanes; ++lane) {
          if ((lanes >> lane & 1U) == 0) continue;
          const Cell cell{x, y, standpoints.low_z(0) + lane};
          best = std::max(best, hits(map, seen, cell, turned.yaw(yaw)));
        }
      }
    }
  }
  ASSERT_FALSE(found.modes.empty());
  EXPECT_EQ(found.modes.front().hits, best);
  for (const Mode& mode : found.modes) {
    EXPECT_EQ(mode.hits, hits(map, seen, mode.cell, turned.yaw(mode.yaw)));
    EXPECT_GE(mode.hits, static_cast<int>(options.keep_share * best));
  }
}

// Columns of one word, and of three.
INSTANTIATE_TEST_SUITE_P(Heights, WideSearchOf, testing::Values(4.0F, 80.0F));

TEST(WideSearch, SaysThatItRanOutOfWork) {
  const OccupancyPyramid map(cloud(3000, 4), 0, 40);
  const Standpoints standpoints(middle_place(), map, {});
  const std::vector<Vector3f> seen = cloud(60, 4);
  const TurnedPoints turned(seen, 12, Eigen::Quaternionf::Identity(), map, {standpoints.low_z(0)});
  WideOptions options;
  options.most_work = 1000;
  EXPECT_TRUE(WideSearch(map, standpoints, turned, options).run(seen.size()).out_of_work);
}

TEST(OccupancyPyramid, ABlockHoldsAllOfItsColumns) {
  const OccupancyPyramid map(cloud(200, 4), 0, 12);
  for (int level = 0; level < OccupancyPyramid::kLevels; ++level) {
    for (int y = -25; y < 25; ++y) {
      for (int x = -25; x < 25; ++x) {
        std::uint64_t all = 0;
        for (int i = 0; i < 1 << (2 * level); ++i) {
          all |= *map.column(0, x + (i & ((1 << level) - 1)), y + (i >> level));
        }
        EXPECT_EQ(all & ~*map.column(level, x, y), 0U) << level << " " << x << " " << y;
      }
    }
  }
}

}  // namespace
}  // namespace holdfast::relocalization
