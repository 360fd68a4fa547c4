#include "holdfast/map/fitting/surface_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "tests/map/clouds.hpp"

namespace holdfast::map {
namespace {

using namespace testing;
using Eigen::Vector3d;

constexpr double kCell = 0.25;

/// Points of a surface within `radius` of a place on it.
double points_on_disc(double radius) { return M_PI * radius * radius / (kSpacing * kSpacing); }

// A plane through n points is off by sigma / sqrt(n) at their centroid and turned by that over
// their RMS extent, half the radius of a disc. The wide neighbourhood reaches two cells, the narrow
// one one.
const double kWideOffset = kNoise / std::sqrt(points_on_disc(2 * kCell));
const double kNarrowOffset = kNoise / std::sqrt(points_on_disc(kCell));
const double kWideAngle = kWideOffset / kCell;
const double kNarrowAngle = kNarrowOffset / (kCell / 2);
// At an edge a plane has half a disc of 1.4 cells, in a corner a quarter: its centroid lies
// 4 r / (3 pi) away from the edge, its RMS extent across the edge is 0.264 r, and it is asked for
// at the edge (or at both).
constexpr double kEdgeLever = 4 / (3 * M_PI) / 0.264;
constexpr double kEdgeExtent = 0.264 * 1.4 * kCell;
const double kHalfDisc = kNoise / std::sqrt(points_on_disc(1.4 * kCell) / 2);
const double kQuarterDisc = kNoise / std::sqrt(points_on_disc(1.4 * kCell) / 4);

/// Five standard deviations of a plane's offset and angle.
struct Tolerance {
  double offset;
  double angle;
};
const Tolerance kAtWall = {5 * kNarrowOffset, 5 * kNarrowAngle};
const Tolerance kAtEdge = {5 * kHalfDisc * std::hypot(1.0, kEdgeLever),
                           5 * kHalfDisc / kEdgeExtent};
const Tolerance kAtCorner = {5 * kQuarterDisc * std::hypot(1.0, kEdgeLever, kEdgeLever),
                             5 * std::sqrt(2.0) * kQuarterDisc / kEdgeExtent};

struct CellFit {
  Vector3d middle;
  std::size_t points = 0;
  std::vector<Surface> surfaces;
};

/// The surfaces of all cells with at least `least` points, where cells are meant to be fitted.
std::vector<CellFit> fit_all(const Points& points, std::size_t least = 4,
                             const FitOptions& changed = {}) {
  FitOptions options = changed;
  options.noise_m = kNoise;
  const PointGrid grid(points, kCell);
  std::vector<CellFit> fits;
  for (const Cell& cell : grid.occupied()) {
    if (grid.points(cell).size() < least) continue;
    CellFit fit{(cell.cast<double>().array() + 0.5) * kCell, grid.points(cell).size(), {}};
    fit_cell(grid, cell, options, fit.surfaces);
    fits.push_back(fit);
  }
  return fits;
}

/// The plane normal . x = offset.
struct TruePlane {
  Vector3d normal;
  double offset;

  double error(const Surface& s) const { return normal.dot(s.center.cast<double>()) - offset; }
  double angle(const Surface& s) const { return normal.cross(s.normal.cast<double>()).norm(); }
  bool is(const Surface& s, const Tolerance& most) const {
    return s.kind == SurfaceKind::kPlane && std::abs(error(s)) < most.offset &&
           angle(s) < most.angle;
  }
};

/// How many surfaces of a cell are `plane`.
int count(const CellFit& fit, const TruePlane& plane, const Tolerance& tolerance) {
  return static_cast<int>(std::count_if(fit.surfaces.begin(), fit.surfaces.end(),
                                        [&](const Surface& s) { return plane.is(s, tolerance); }));
}

double rms(const std::vector<double>& values) {
  const double sum = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(FitCell, ATiltedWallIsOnePlaneInEveryCell) {
  RandomStream random(1, "tilted wall");
  const TruePlane wall{Vector3d(0.3, -0.5, 0.8).normalized(), 0.4};
  const Vector3d u = wall.normal.unitOrthogonal();
  const Vector3d v = wall.normal.cross(u);
  Points points;
  add_patch(wall.offset * wall.normal - 2 * u - 2 * v, 4 * u, 4 * v, random, points);
  std::vector<double> errors, angles, thickness;
  for (const CellFit& fit : fit_all(points, 1)) {
    ASSERT_EQ(fit.surfaces.size(), 1U);
    const Surface& s = fit.surfaces[0];
    EXPECT_EQ(s.kind, SurfaceKind::kPlane);
    EXPECT_EQ(s.more, 0);
    EXPECT_NEAR(s.normal.norm(), 1.0F, 1e-6F);
    if (std::abs(u.dot(fit.middle)) > 1.4 || std::abs(v.dot(fit.middle)) > 1.4) continue;
    EXPECT_TRUE(wall.is(s, kAtWall));
    errors.push_back(wall.error(s));
    angles.push_back(wall.angle(s));
    thickness.push_back(s.sigma_m);
    // On a disc of one cell's radius.
    EXPECT_NEAR(s.support, points_on_disc(kCell), 0.25 * points_on_disc(kCell));
  }
  EXPECT_GT(errors.size(), 100U);
  EXPECT_LT(rms(errors), 1.5 * kWideOffset);
  EXPECT_LT(rms(angles), 1.5 * std::sqrt(2.0) * kWideAngle);  // about two axes
  EXPECT_NEAR(mean(thickness), kNoise, 0.05 * kNoise);
}

class AWallAcrossACell : public ::testing::TestWithParam<double> {};

TEST_P(AWallAcrossACell, IsUnbiased) {
  RandomStream random(2, "wall");
  const TruePlane wall{Vector3d::UnitX(), 1.0 + GetParam() * kCell};
  Points points;
  add_patch({wall.offset, 0, 0}, {0, 4, 0}, {0, 0, 3}, random, points);
  std::vector<double> errors;
  for (const CellFit& fit : fit_all(points)) {
    ASSERT_EQ(fit.surfaces.size(), 1U);
    EXPECT_TRUE(wall.is(fit.surfaces[0], kAtEdge));
    errors.push_back(wall.error(fit.surfaces[0]));
  }
  // Together the fits use every point about equally.
  EXPECT_LT(std::abs(mean(errors)), 3 * kNoise / std::sqrt(static_cast<double>(points.size())));
}

// 0: the wall coincides with the border of two cells, each of which holds half of its points.
INSTANTIATE_TEST_SUITE_P(At, AWallAcrossACell, ::testing::Values(0.0, 0.02, 0.1, 0.5, 0.98));

TEST(FitCell, AnEdgeIsTwoPlanesInEveryCellThatItPasses) {
  RandomStream random(3, "edge");
  const TruePlane floor{Vector3d::UnitZ(), 0.1};
  const TruePlane wall{Vector3d::UnitX(), 0.1};
  Points points;
  add_patch({0.1, 0, 0.1}, {3, 0, 0}, {0, 4, 0}, random, points);
  add_patch({0.1, 0, 0.1}, {0, 4, 0}, {0, 0, 3}, random, points);
  int edge_cells = 0;
  for (const CellFit& fit : fit_all(points)) {
    const bool on_edge = fit.middle.x() < kCell && fit.middle.z() < kCell;
    EXPECT_EQ(fit.surfaces.size(), on_edge ? 2U : 1U) << fit.middle.transpose();
    EXPECT_EQ(count(fit, floor, kAtEdge), fit.middle.z() < kCell ? 1 : 0) << fit.middle.transpose();
    EXPECT_EQ(count(fit, wall, kAtEdge), fit.middle.x() < kCell ? 1 : 0) << fit.middle.transpose();
    if (!on_edge || fit.surfaces.size() != 2) continue;
    EXPECT_EQ(fit.surfaces[0].more, 1);
    EXPECT_EQ(fit.surfaces[1].more, 0);
    ++edge_cells;
  }
  EXPECT_EQ(edge_cells, 16);
}

/// Three walls that meet at (at, at, at), a metre wide.
Points corner(double at, std::uint64_t seed) {
  RandomStream random(seed, "corner");
  Points points;
  add_patch({at, at, at}, {1, 0, 0}, {0, 1, 0}, random, points);
  add_patch({at, at, at}, {0, 1, 0}, {0, 0, 1}, random, points);
  add_patch({at, at, at}, {1, 0, 0}, {0, 0, 1}, random, points);
  return points;
}

/// What became of the cells of many corners and of the edges that lead to them.
struct CornerCounts {
  int cells = 0;
  int complete = 0;          ///< hold every plane that passes through them, and nothing else
  int with_false_plane = 0;  ///< hold a plane that is none of the three

  void add(const CellFit& fit, double at) {
    std::size_t expected = 0;
    std::size_t right = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const TruePlane wall{Vector3d::Unit(axis), at};
      expected += fit.middle[axis] < kCell ? 1 : 0;
      right += count(fit, wall, kAtCorner) == 1 ? 1 : 0;
    }
    ++cells;
    complete += right == expected && fit.surfaces.size() == expected ? 1 : 0;
    with_false_plane += fit.surfaces.size() > right ? 1 : 0;
  }
};

struct Corners : ::testing::Test {
  CornerCounts corners;
  CornerCounts edges;

  Corners() {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      for (const double at : {0.06, 0.1, 0.14}) {
        for (const CellFit& fit : fit_all(corner(at, seed))) {
          const auto walls = (fit.middle.array() < kCell).count();
          if (fit.middle.maxCoeff() > 3 * kCell) continue;  // the far ends of the walls
          if (walls == 3) corners.add(fit, at);
          if (walls == 2) edges.add(fit, at);
        }
      }
    }
  }
};

TEST_F(Corners, NineOfTenCellsOnAnEdgeHoldItsTwoPlanesAndNothingElse) {
  EXPECT_EQ(edges.cells, 60 * 3 * 6);
  EXPECT_GT(edges.complete, 0.9 * edges.cells);
}

TEST_F(Corners, APlaneAcrossAnEdgeIsRare) {
  // It would be a wall that is not there, in places that every scan of a room sees.
  EXPECT_LT(edges.with_false_plane, 0.01 * edges.cells);
}

TEST_F(Corners, MostCellsInACornerHoldItsThreePlanesAndNothingElse) {
  EXPECT_EQ(corners.cells, 60 * 3);
  EXPECT_GT(corners.complete, 0.6 * corners.cells);
}

class AThinWall : public ::testing::TestWithParam<double> {};

TEST_P(AThinWall, HasTwoSidesTenCentimetresApart) {
  RandomStream random(5, "thin wall");
  constexpr double kThickness = 0.1;
  const TruePlane near{Vector3d::UnitX(), GetParam()};
  const TruePlane far{Vector3d::UnitX(), GetParam() + kThickness};
  Points points;
  add_patch({near.offset, 0, 0}, {0, 4, 0}, {0, 0, 3}, random, points);
  add_patch({far.offset, 0, 0}, {0, 4, 0}, {0, 0, 3}, random, points);
  int cells = 0;
  int right = 0;
  int between = 0;
  std::vector<double> thickness;
  for (const CellFit& fit : fit_all(points)) {
    ++cells;
    for (const Surface& s : fit.surfaces) {
      const double from_near = near.error(s);
      between += from_near > 0.02 && from_near < kThickness - 0.02 ? 1 : 0;
    }
    const bool both =
        fit.surfaces.size() == 2 && count(fit, near, kAtEdge) == 1 && count(fit, far, kAtEdge) == 1;
    if (!both) continue;
    ++right;
    thickness.push_back(std::abs(near.error(fit.surfaces[0]) - near.error(fit.surfaces[1])));
  }
  EXPECT_GT(right, 0.95 * cells);
  // A plane between the sides would pull every scan that sees one of them.
  EXPECT_LE(between, 0.02 * cells);
  ASSERT_FALSE(thickness.empty());
  // Each side is used whole, on average.
  EXPECT_NEAR(mean(thickness), kThickness,
              3 * kNoise / std::sqrt(static_cast<double>(points.size()) / 4));
}

// Both sides in one row of cells, and one each side of a border.
INSTANTIATE_TEST_SUITE_P(At, AThinWall, ::testing::Values(0.06, 0.20));

TEST(FitCell, ThePlanesOfAColumnExplainItsPoints) {
  RandomStream random(6, "column");
  constexpr double kRadius = 0.3;
  const Vector3d axis(1, 1, 0);
  Points points;
  add_cylinder(axis, kRadius, 2.0, random, points);
  int explained = 0;
  std::vector<double> depths;
  const PointGrid grid(points, kCell);
  for (const CellFit& fit : fit_all(points, 1)) {
    for (const Surface& s : fit.surfaces) {
      if (s.kind == SurfaceKind::kClutter) continue;
      ASSERT_EQ(s.kind, SurfaceKind::kPlane);
      const double distance = std::abs(s.normal.cast<double>().dot(s.center.cast<double>() - axis));
      depths.push_back(std::abs(kRadius - distance));
    }
    for (const auto& p : grid.points(grid.cell_of(fit.middle.cast<float>()))) {
      explained += std::any_of(fit.surfaces.begin(), fit.surfaces.end(),
                               [&](const Surface& s) {
                                 return s.kind == SurfaceKind::kPlane &&
                                        std::abs(s.normal.dot(p - s.center)) < 3 * kNoise;
                               })
                       ? 1
                       : 0;
    }
  }
  // Cells that planes do not explain are clutter.
  EXPECT_GT(explained, 0.9 * static_cast<double>(points.size()));
  // A plane is the mean of a band of three sigmas to each side: it lies between the tangent and the
  // chord of a segment that is 2 * 3 sigma deep.
  ASSERT_FALSE(depths.empty());
  std::nth_element(depths.begin(), depths.begin() + static_cast<long>(depths.size() / 2),
                   depths.end());
  EXPECT_LT(depths[depths.size() / 2], 6 * kNoise);
}

TEST(FitCell, ARowOfPointsIsALine) {
  RandomStream random(7, "pole");
  const Vector3d foot(1.1, 1.13, 0);
  Points points;
  for (int i = 0; i < 300; ++i) {
    points.push_back((foot + Vector3d(0, 0, 0.01 * i) + noise(random, kNoise)).cast<float>());
  }
  const auto fits = fit_all(points);
  ASSERT_GE(fits.size(), 12U);
  for (const CellFit& fit : fits) {
    ASSERT_EQ(fit.surfaces.size(), 1U) << fit.middle.transpose();
    const Surface& s = fit.surfaces[0];
    EXPECT_EQ(s.kind, SurfaceKind::kLine);
    // At least a cell's length of points to one side: 25 of them, asked for at their end, with an
    // RMS extent of a cell / sqrt(12); about two axes each.
    const double across = 5 * kNoise / std::sqrt(25.0);
    EXPECT_LT((s.center.head<2>().cast<double>() - foot.head<2>()).norm(), 2 * across);
    EXPECT_LT(s.normal.head<2>().norm(), across / (kCell / std::sqrt(12.0)));
    EXPECT_NEAR(s.sigma_m, kNoise, 0.5 * kNoise);
  }
}

TEST(FitCell, WithoutLinesARowOfPointsIsNothing) {
  RandomStream random(7, "pole");
  Points points;
  for (int i = 0; i < 300; ++i) {
    points.push_back((Vector3d(1.1, 1.1, 0.01 * i) + noise(random, kNoise)).cast<float>());
  }
  FitOptions options;
  options.lines = false;
  for (const CellFit& fit : fit_all(points, 4, options)) EXPECT_TRUE(fit.surfaces.empty());
}

TEST(FitCell, PlanesInACloudWithoutSurfacesHaveLittleSupport) {
  RandomStream random(8, "foliage");
  Points points;
  for (int i = 0; i < 4000; ++i) {
    points.push_back(Eigen::Vector3f(static_cast<float>(random.uniform(0, 2)),
                                     static_cast<float>(random.uniform(0, 2)),
                                     static_cast<float>(random.uniform(0, 2))));
  }
  for (const CellFit& fit : fit_all(points)) {
    // A wall that fills its cells with as many points has this support.
    const double wall = static_cast<double>(fit.points) * M_PI;
    for (const Surface& s : fit.surfaces) EXPECT_LT(s.support, std::max(0.5 * wall, 10.0));
  }
}

TEST(FitCell, AFewPointsAreNothing) {
  RandomStream random(9, "few");
  Points points;
  for (int i = 0; i < FitOptions{}.min_support - 1; ++i) {
    points.push_back(Eigen::Vector3f(static_cast<float>(random.uniform(0, 0.2)),
                                     static_cast<float>(random.uniform(0, 0.2)), 0.1F));
  }
  const auto fits = fit_all(points, 1);
  ASSERT_EQ(fits.size(), 1U);
  EXPECT_TRUE(fits[0].surfaces.empty());
}

TEST(PlaneThickness, IsTheNoiseOfAWallAndNegativeForAFewPoints) {
  RandomStream random(10, "wall");
  Points points;
  add_patch({1.1, 0, 0}, {0, 2, 0}, {0, 0, 2}, random, points);
  const PointGrid grid(points, kCell);
  std::vector<double> thickness;
  for (const Cell& cell : grid.occupied()) {
    thickness.push_back(plane_thickness(grid, cell, FitOptions{}).sigma_m);
  }
  EXPECT_NEAR(mean(thickness), kNoise, 0.1 * kNoise);
  const PointGrid few(Points(3, {0.1F, 0.1F, 0.1F}), kCell);
  EXPECT_EQ(plane_thickness(few, Cell(0, 0, 0), FitOptions{}).support, 0);
}

}  // namespace
}  // namespace holdfast::map
