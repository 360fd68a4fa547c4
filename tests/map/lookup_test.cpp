#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "tests/map/built_map.hpp"
#include "tests/map/clouds.hpp"

namespace holdfast::map {
namespace {

using namespace testing;
using Eigen::Vector3d;

constexpr double kRadius = 100.0;

io::PointCloud cloud_of(Points points) {
  io::PointCloud cloud;
  cloud.points = std::move(points);
  return cloud;
}

/// A floor of 8 x 4 m at z = 0 and a wall at y = 4, moved by `shift`.
io::PointCloud floor_and_wall(const Vector3d& shift) {
  RandomStream random(1, "room");
  Points points;
  add_patch(shift, {8, 0, 0}, {0, 4, 0}, random, points);
  add_patch(shift + Vector3d(0, 4, 0), {8, 0, 0}, {0, 0, 3}, random, points);
  return cloud_of(std::move(points));
}

PriorMap focused(const BuiltMap& built, const Vector3d& p) {
  PriorMap map = built.open();
  const auto status = map.focus(p, kRadius);
  EXPECT_TRUE(status) << status.error().message;
  return map;
}

/// Surfaces of a cell in map coordinates.
struct Found {
  Vector3d center;
  Vector3d normal;
  bool more;
};
std::vector<Found> find_all(const PriorMap& map, int level, const Vector3d& p) {
  std::vector<Found> found;
  const auto hit = map.find(level, (p - map.anchor()).cast<float>());
  for (const Surface* s = hit.surface; s != nullptr; ++s) {
    const Vector3d center = map.anchor() + (hit.corner + s->center).cast<double>();
    found.push_back({center, s->normal.cast<double>(), s->more != 0});
    if (s->more == 0) break;
  }
  return found;
}

/// Distance of `p` to the nearest surface of its cell; < 0 without any.
double distance(const PriorMap& map, int level, const Vector3d& p) {
  double least = -1;
  for (const Found& f : find_all(map, level, p)) {
    const double d = std::abs(f.normal.dot(p - f.center));
    least = least < 0 ? d : std::min(least, d);
  }
  return least;
}

// Half a disc of one cell of 0.25 m: points at the rim of a patch.
const double kFit = 5 * kNoise / std::sqrt(M_PI * 0.25 * 0.25 / (kSpacing * kSpacing) / 2) * 2;

struct Room : ::testing::Test {
  BuiltMap built{floor_and_wall({1, 1, 0})};
  PriorMap map = focused(built, {4, 3, 0});
};

TEST_F(Room, APointOnAWallFindsIt) {
  ASSERT_EQ(built.info().levels[0].cell_m, 0.25);
  for (int level = 0; level < kLevels; ++level) {
    EXPECT_LT(distance(map, level, {4.1, 3.1, 0.0}), kFit) << "level " << level;
    EXPECT_GE(distance(map, level, {4.1, 3.1, 0.0}), 0) << "level " << level;
    EXPECT_LT(distance(map, level, {4.1, 5.0, 1.6}), kFit) << "level " << level;
    EXPECT_GE(distance(map, level, {4.1, 5.0, 1.6}), 0) << "level " << level;
  }
}

TEST_F(Room, AnEmptyCellBesideAWallBorrowsIt) {
  for (int level = 0; level < kLevels; ++level) {
    const double cell = built.info().levels[static_cast<std::size_t>(level)].cell_m;
    for (const double side : {-1.0, 1.0}) {
      // The next cell's middle is between half and one and a half cells away.
      const Vector3d p(4.1, 5.0 + side * cell, 1.6);
      const double expected = cell;
      EXPECT_NEAR(distance(map, level, p), expected, kFit + 2 * cell * 0.03)
          << "level " << level << ", side " << side;
    }
  }
}

TEST_F(Room, AFarCellFindsNothing) {
  for (int level = 0; level < kLevels; ++level) {
    const double cell = built.info().levels[static_cast<std::size_t>(level)].cell_m;
    EXPECT_LT(distance(map, level, {4.1, 5.0 + 2.1 * cell + 0.1, 1.6}), 0) << "level " << level;
    EXPECT_LT(distance(map, level, {4.1, 2.5, 2.3}), 0) << "level " << level;
    EXPECT_LT(distance(map, level, {4.1, 3.0, -40.0}), 0) << "level " << level;
    EXPECT_LT(distance(map, level, {4.1, 3.0, 900.0}), 0) << "level " << level;
  }
}

TEST_F(Room, WithoutATileThereIsNothing) {
  EXPECT_LT(distance(map, 0, {500.0, 3.0, 0.0}), 0);
  EXPECT_LT(distance(map, 0, {-500.0, -3.0, 0.0}), 0);
}

TEST_F(Room, ACoarserLevelReachesFarther) {
  const Vector3d p(4.1, 3.1, 0.8);  // above the floor
  EXPECT_LT(distance(map, 0, p), 0);
  EXPECT_NEAR(distance(map, 2, p), 0.8, kFit + 0.8 * 0.03);
}

TEST_F(Room, AnEdgeHasBothPlanesInOneCell) {
  const auto found = find_all(map, 0, {4.1, 4.95, 0.05});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_TRUE(found[0].more);
  EXPECT_FALSE(found[1].more);
  EXPECT_LT(std::abs(found[0].normal.dot(found[1].normal)), 0.2);
}

/// A wall at y = 4 up to x, from where on a door stands 14 cm deep in it.
io::PointCloud wall_with_door_at(double x, std::uint64_t seed) {
  RandomStream random(seed, "door");
  Points points;
  add_patch({x - 3, 4, 0}, {3, 0, 0}, {0, 0, 2.1}, random, points);
  add_patch({x, 4, 0}, {0, 0.14, 0}, {0, 0, 2.1}, random, points);
  add_patch({x, 4.14, 0}, {1, 0, 0}, {0, 0, 2.1}, random, points);
  return cloud_of(std::move(points));
}

/// Distances of returns from a door jamb at x to the plane that they find.
struct JambReturns {
  static constexpr double kRangeSigma = 0.02;
  double sum = 0;
  int returns = 0, paired = 0;

  void add(const PriorMap& map, double x, RandomStream& random) {
    const Vector3d on(x, random.uniform(4.05, 4.09), random.uniform(0.2, 1.9));
    const Vector3d p = on + Vector3d(kRangeSigma * random.normal(), 0, 0);
    ++returns;
    for (const Found& f : find_all(map, 0, p)) {
      const double d = f.normal.dot(p - f.center);
      if (std::abs(f.normal.x()) < 0.9 || std::abs(d) > 3 * kRangeSigma) continue;
      sum += f.normal.x() > 0 ? d : -d;
      ++paired;
      return;
    }
  }
};

/// Cells begin at multiples of 0.25 m.
class ADoorJamb : public ::testing::TestWithParam<double> {};

TEST_P(ADoorJamb, GivesANoiseWithoutMeanWhereverCellsBegin) {
  const double x = 5.0 + GetParam();
  JambReturns found;
  for (std::uint64_t survey = 1; survey <= 8; ++survey) {
    const BuiltMap built(wall_with_door_at(x, survey));
    const PriorMap map = focused(built, {4, 3, 1});
    RandomStream random(survey, "returns");
    for (int k = 0; k < 1000; ++k) found.add(map, x, random);
  }
  EXPECT_GT(found.paired, 0.7 * found.returns);
  EXPECT_LT(std::abs(found.sum / found.paired), 0.002);  // of one side alone: 16 mm
}

INSTANTIATE_TEST_SUITE_P(At, ADoorJamb, ::testing::Values(0.0, 0.01, -0.01, 0.03, -0.03, 0.12));

TEST_F(Room, EverySurfaceThatIsFoundLiesNearItsCell) {
  RandomStream random(2, "places");
  int hits = 0;
  for (int k = 0; k < 20'000; ++k) {
    const Vector3d p(random.uniform(0, 10), random.uniform(0, 6), random.uniform(-1, 4));
    for (int level = 0; level < kLevels; ++level) {
      const double cell = built.info().levels[static_cast<std::size_t>(level)].cell_m;
      for (const Found& f : find_all(map, level, p)) {
        // Of its own cell, one of the 26 around it, or of a neighbour that has adopted it; the
        // centre may stand out by the noise.
        EXPECT_LT((f.center - p).cwiseAbs().maxCoeff(), 3 * cell + 5 * kNoise);
        ++hits;
      }
    }
  }
  EXPECT_GT(hits, 1000);
}

class ATileBorder : public ::testing::TestWithParam<std::array<double, 2>> {
 protected:
  /// The border between two tiles lies where GetParam() says, the room lies across it.
  Vector3d corner() const { return {GetParam()[0] - 4.25, GetParam()[1] - 2.25, 0}; }
};

TEST_P(ATileBorder, CannotBeSeenInTheSurfaces) {
  // The same room well inside of one tile, moved by whole cells of the coarsest level.
  const BuiltMap across(floor_and_wall(corner()));
  const Vector3d inside_corner(9.75, 9.75, 0);
  const BuiltMap inside(floor_and_wall(inside_corner));
  EXPECT_GT(across.info().tiles.size(), 1U);
  EXPECT_EQ(inside.info().tiles.size(), 1U);
  const PriorMap at_border = focused(across, corner());
  const PriorMap in_tile = focused(inside, inside_corner);
  RandomStream random(3, "places");
  constexpr int kPlaces = 5000;
  int found = 0;
  int differ = 0;
  for (int k = 0; k < kPlaces; ++k) {
    const Vector3d d(random.uniform(0, 8), random.uniform(0, 4.1), random.uniform(-0.2, 3));
    const double a = distance(at_border, 0, corner() + d);
    const double b = distance(in_tile, 0, inside_corner + d);
    found += b >= 0 ? 1 : 0;
    differ += std::abs(a - b) > 0.1 * kNoise ? 1 : 0;
  }
  EXPECT_GT(found, 1000);
  // Floats round otherwise in another place: a few points change sides of a cell or of a fit's
  // limit.
  EXPECT_LT(differ, 0.02 * found);
}

TEST_P(ATileBorder, HasTheFloorOnBothSides) {
  const BuiltMap built(floor_and_wall(corner()));
  const PriorMap map = focused(built, corner());
  for (double along = -2; along <= 2; along += 0.05) {
    for (const double side : {-1e-4, 1e-4}) {
      const Vector3d over_x(GetParam()[0] + side, corner().y() + 2 + along / 2, 0);
      const Vector3d over_y(corner().x() + 4 + along, GetParam()[1] + side, 0);
      for (const Vector3d& p : {over_x, over_y}) {
        const double d = distance(map, 0, p);
        EXPECT_GE(d, 0) << p.transpose();
        EXPECT_LT(d, kFit) << p.transpose();
      }
    }
  }
}

TEST_P(ATileBorder, IsCrossedByTheAnchorWithoutAnotherAnswer) {
  const BuiltMap built(floor_and_wall(corner()));
  const PriorMap low = focused(built, {GetParam()[0] - 1, GetParam()[1] - 1, 0});
  const PriorMap high = focused(built, {GetParam()[0] + 1, GetParam()[1] + 1, 0});
  EXPECT_GT((low.anchor() - high.anchor()).norm(), kTileSizeM - 1);
  RandomStream random(4, "places");
  for (int k = 0; k < 5000; ++k) {
    // On a grid of 1/1024 m, which floats and both anchors hold exactly.
    const Vector3d d(static_cast<double>(random.below(8192)) / 1024,
                     static_cast<double>(random.below(4200)) / 1024,
                     static_cast<double>(random.below(1024)) / 1024);
    const auto a = find_all(low, 0, corner() + d);
    const auto b = find_all(high, 0, corner() + d);
    ASSERT_EQ(a.size(), b.size()) << d.transpose();
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_LT((a[i].center - b[i].center).norm(), 1e-5);  // floats of up to 64 m
      EXPECT_EQ(a[i].normal, b[i].normal);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(At, ATileBorder,
                         ::testing::Values(std::array{32.0, 16.0}, std::array{32.0, 32.0},
                                           std::array{0.0, 0.0}, std::array{-64.0, -96.0}));

TEST(LookUp, NegativeCoordinatesAreAsGoodAsPositiveOnes) {
  const Vector3d corner(-75.0, -43.0, -12.0);
  const BuiltMap built(floor_and_wall(corner));
  const PriorMap map = focused(built, corner);
  for (int level = 0; level < kLevels; ++level) {
    const double on_floor = distance(map, level, corner + Vector3d(3.1, 2.1, 0));
    EXPECT_GE(on_floor, 0);
    EXPECT_LT(on_floor, kFit);
    const double on_wall = distance(map, level, corner + Vector3d(3.1, 4, 1.5));
    EXPECT_GE(on_wall, 0);
    EXPECT_LT(on_wall, kFit);
  }
}

TEST(LookUp, CoordinatesOfAProjectionKeepTheirMillimetres) {
  // UTM: 6 million metres, where a float knows half a metre.
  io::PointCloud cloud = floor_and_wall({3.1, 2.2, 1.3});
  cloud.origin = {456'789.0, 5'987'654.0, 312.0};
  const Vector3d corner = cloud.origin + Vector3d(3.1, 2.2, 1.3);
  const BuiltMap built(std::move(cloud));
  const PriorMap map = focused(built, corner);
  EXPECT_LT((map.anchor() - corner).head<2>().cwiseAbs().maxCoeff(), 2 * kTileSizeM);
  double worst = 0;
  for (double x = 1; x < 7; x += 0.2) {
    const double on_floor = distance(map, 0, corner + Vector3d(x, 2.1, 0));
    ASSERT_GE(on_floor, 0);
    worst = std::max(worst, on_floor);
  }
  EXPECT_LT(worst, kFit);
  EXPECT_LT((built.info().bounds_min - corner).cwiseAbs().maxCoeff(), 0.1);
}

TEST(LookUp, EdgesGivenApartBecomeLines) {
  RandomStream random(5, "features");
  Points planes;
  add_patch({1, 1, 0}, {8, 0, 0}, {0, 6, 0}, random, planes);
  Points edges;
  for (int i = 0; i < 400; ++i) {
    edges.push_back((Vector3d(4.1, 3.1, 1.0 + 0.01 * i) + noise(random, kNoise)).cast<float>());
  }
  MapSource source{cloud_of(planes), cloud_of(edges), "features"};
  const BuiltMap built(std::move(source));
  EXPECT_GT(built.info().levels[0].lines, 0U);
  const PriorMap map = focused(built, {4, 3, 0});
  const auto hit = map.find(0, Eigen::Vector3f(4.1F, 3.1F, 3.0F));
  ASSERT_NE(hit.surface, nullptr);
  EXPECT_EQ(hit.surface->kind, SurfaceKind::kLine);
  EXPECT_GT(std::abs(hit.surface->normal.z()), 0.95F);
  const auto floor = map.find(0, Eigen::Vector3f(6.0F, 5.0F, 0.0F));
  ASSERT_NE(floor.surface, nullptr);
  EXPECT_EQ(floor.surface->kind, SurfaceKind::kPlane);
}

}  // namespace
}  // namespace holdfast::map
