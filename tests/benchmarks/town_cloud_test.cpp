#include "benchmarks/drives/town_cloud.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "benchmarks/drives/surveyed_drive.hpp"

namespace holdfast::benchmarks {
namespace {

TEST(Town, HasTheFirstWorldAtItsOwnPlaceAndTheOthersBesideIt) {
  // The small box stands for the warehouse.
  auto drive = make_drive({"box", 1, 1.0, 2});
  ASSERT_TRUE(drive) << drive.error().message;
  const auto first = (*drive)->survey_map();
  const std::size_t count = first.points.size() + 300'000;
  const auto town = make_town(count, **drive, 2);
  ASSERT_TRUE(town) << town.error().message;
  ASSERT_EQ(town->points.size(), count);
  Eigen::AlignedBox3f own, others;
  for (std::size_t i = 0; i < count; ++i) {
    if (i < first.points.size()) {
      ASSERT_EQ(town->points[i], first.points[i]);
      own.extend(first.points[i]);
    } else {
      others.extend(town->points[i]);
    }
  }
  EXPECT_NEAR(others.min().x() - own.max().x(), 5.0, 1e-3);
  // The corridor and the office, 55 m apart on the grid.
  EXPECT_GT(others.sizes().y(), 55.0F);
}

}  // namespace
}  // namespace holdfast::benchmarks
