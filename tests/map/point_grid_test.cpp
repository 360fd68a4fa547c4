#include "holdfast/map/fitting/point_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "holdfast/core/random.hpp"

namespace holdfast::map {
namespace {

std::vector<Eigen::Vector3f> random_points(std::size_t n) {
  RandomStream random(1, "points");
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < n; ++i) {
    points.emplace_back(static_cast<float>(random.uniform(-3, 2)),
                        static_cast<float>(random.uniform(-1, 4)),
                        static_cast<float>(random.uniform(-2, 1)));
  }
  return points;
}

TEST(PointGrid, EveryPointIsInItsCellOnce) {
  const auto points = random_points(2000);
  const PointGrid grid(points, 0.5);
  std::size_t found = 0;
  for (const Cell& cell : grid.occupied()) {
    EXPECT_GT(grid.points(cell).size(), 0U);
    for (const auto& p : grid.points(cell)) {
      EXPECT_EQ(grid.cell_of(p), cell);
      ++found;
    }
  }
  EXPECT_EQ(found, points.size());
}

TEST(PointGrid, OccupiedCellsAreInTheOrderZYX) {
  const PointGrid grid(random_points(2000), 0.5);
  const auto& cells = grid.occupied();
  EXPECT_TRUE(std::is_sorted(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) {
    return std::tuple(a.z(), a.y(), a.x()) < std::tuple(b.z(), b.y(), b.x());
  }));
}

TEST(PointGrid, ACellReachesFromItsLowBorderToItsHighOne) {
  const PointGrid grid({{0.5F, 0, 0}, {0.49999F, 0, 0}, {-0.00001F, 0, 0}}, 0.5);
  EXPECT_EQ(grid.points(Cell(1, 0, 0)).size(), 1U);
  EXPECT_EQ(grid.points(Cell(0, 0, 0)).size(), 1U);
  EXPECT_EQ(grid.points(Cell(-1, 0, 0)).size(), 1U);
}

TEST(PointGrid, CellsOutsideOfTheBoxAreEmpty) {
  const PointGrid grid({{0.1F, 0.1F, 0.1F}}, 0.5);
  for (const Cell& cell : {Cell(1, 0, 0), Cell(0, -1, 0), Cell(0, 0, 5), Cell(-9, 0, 0)}) {
    EXPECT_EQ(grid.points(cell).size(), 0U);
  }
}

TEST(PointGrid, WithoutPointsThereIsNothing) {
  const PointGrid grid({}, 0.5);
  EXPECT_TRUE(grid.occupied().empty());
  EXPECT_EQ(grid.points(Cell(0, 0, 0)).size(), 0U);
}

}  // namespace
}  // namespace holdfast::map
