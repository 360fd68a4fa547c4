#include "holdfast/odometry/surroundings/local_map.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "holdfast/core/random.hpp"
#include "tests/tolerances.hpp"

namespace holdfast::odometry {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kNoise = 0.02;
constexpr double kHalf = 0.12;  // of the smallest cells, nearly

/// Points on a square of the plane through `middle` with normal `n`, with noise along n.
std::vector<Vector3f> plane_points(const Vector3d& n, const Vector3d& middle, int count,
                                   std::uint64_t seed, double half = kHalf) {
  RandomStream random(seed, "plane");
  const Vector3d u = n.unitOrthogonal();
  const Vector3d v = n.cross(u);
  std::vector<Vector3f> points;
  for (int i = 0; i < count; ++i) {
    const Vector3d p = middle + random.uniform(-half, half) * u + random.uniform(-half, half) * v +
                       random.normal(0, kNoise) * n;
    points.push_back(p.cast<float>());
  }
  return points;
}

Vector3d kMiddle() { return {2.125, 1.125, 0.125}; }  // the middle of a cell of the smallest size
Vector3d kSeenFrom() { return kMiddle() + Vector3d(1.5, 1.0, 2.5); }

TEST(LocalMap, APlaneIsAsGoodAsItSaysItIs) {
  const Vector3d n = Vector3d(0.05, -0.03, 1).normalized();
  constexpr double kLargeHalf = 0.48;  // of the largest cells, which answer
  double squares = 0, sum_sigma = 0;
  constexpr int kDraws = 400;
  int asked = 0;
  LocalMap map({}, kNoise);
  for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
    // Each draw in a cell of its own.
    const Vector3d middle = Vector3d(0.5, 0.5, 0.5) + Vector3d(2.0 * static_cast<double>(seed % 20),
                                                               static_cast<double>(seed / 20), 0);
    map.insert(plane_points(n, middle, 150, seed, kLargeHalf), {}, middle + 3.0 * n);
    const auto hit = map.find(0, middle.cast<float>());
    ASSERT_NE(hit.surface, nullptr);
    ASSERT_EQ(hit.surface->kind, map::SurfaceKind::kPlane);
    // The error of the plane somewhere in the cell, as a matched point meets it.
    RandomStream random(seed, "where");
    const Vector3d u = n.unitOrthogonal();
    const Vector3d at = middle + random.uniform(-kLargeHalf, kLargeHalf) * u +
                        random.uniform(-kLargeHalf, kLargeHalf) * n.cross(u);
    if ((at - middle).cwiseAbs().maxCoeff() > 0.5) continue;  // the square lies askew in the cell
    ++asked;
    const double error = hit.surface->normal.cast<double>().dot(
        at - (hit.corner + hit.surface->center).cast<double>());
    squares += error * error / (hit.surface->sigma_m * hit.surface->sigma_m);
    sum_sigma += hit.surface->sigma_m;
  }
  ASSERT_GT(asked, kDraws / 2);
  // Mean of squares of unit variance, of some 300 draws: 1 +- 0.08.
  EXPECT_NEAR(squares / asked, 1.0, 0.35);
  EXPECT_LT(sum_sigma / asked, 0.005);
}

TEST(LocalMap, PointsOnALineAreNoPlane) {
  LocalMap map({}, kNoise);
  RandomStream random(1, "line");
  std::vector<Vector3f> points;
  for (int i = 0; i < 80; ++i) {
    points.push_back((kMiddle() + Vector3d(random.uniform(-kHalf, kHalf), random.normal(0, 0.004),
                                           random.normal(0, 0.004)))
                         .cast<float>());
  }
  map.insert(points, {}, kSeenFrom());
  EXPECT_EQ(map.find(0, kMiddle().cast<float>()).surface, nullptr);
}

TEST(LocalMap, APlaneThroughTheLidarIsTheFanOfABeamAndNoWall) {
  LocalMap map({}, kNoise);
  const Vector3d n = Vector3d(0.3, 0.2, 1).normalized();
  map.insert(plane_points(n, kMiddle(), 100, 1), {}, kMiddle() + 3.0 * n.unitOrthogonal());
  EXPECT_EQ(map.find(0, kMiddle().cast<float>()).surface, nullptr);
}

TEST(LocalMap, TheCellOfACornerIsNoPlane) {
  LocalMap map({}, kNoise);
  map.insert(plane_points(Vector3d::UnitX(), kMiddle(), 100, 1), {}, kSeenFrom());
  map.insert(plane_points(Vector3d::UnitZ(), kMiddle(), 100, 2), {}, kSeenFrom());
  EXPECT_EQ(map.find(0, kMiddle().cast<float>()).surface, nullptr);
}

TEST(LocalMap, NothingIsKnownWhereNothingWasSeen) {
  LocalMap map({}, kNoise);
  EXPECT_EQ(map.find(0, {1, 2, 3}).surface, nullptr);
  map.insert(plane_points(Vector3d::UnitZ(), kMiddle(), 100, 1), {}, kSeenFrom());
  EXPECT_EQ(map.find(0, {-1, 2, 3}).surface, nullptr);
  EXPECT_NE(map.find(0, kMiddle().cast<float>()).surface, nullptr);
  map.clear();
  EXPECT_EQ(map.find(0, kMiddle().cast<float>()).surface, nullptr);
}

TEST(LocalMap, APlaneFarFromTheOriginIsAsGoodAsOneNearby) {
  const auto points = plane_points(Vector3d::UnitZ(), kMiddle(), 100, 1);
  LocalMap near({}, kNoise), far({}, kNoise);
  // A multiple of the cells, so that the points fall into their cells alike.
  const SE3 away{Eigen::Quaterniond::Identity(), {40'000, -30'000, 12}};
  far.follow(away.translation);
  near.insert(points, {}, kSeenFrom());
  far.insert(points, away, kSeenFrom());
  const auto a = near.find(0, kMiddle().cast<float>());
  const Vector3f p = (kMiddle() + away.translation - far.anchor()).cast<float>();
  const auto b = far.find(0, p);
  ASSERT_NE(a.surface, nullptr);
  ASSERT_NE(b.surface, nullptr);
  // Floats of up to 64 m.
  EXPECT_LT((a.surface->center - b.surface->center).norm(), 64 * 1e-7F * 2);
  EXPECT_LT((p - b.corner - (kMiddle().cast<float>() - a.corner)).norm(), 1e-5F);
}

TEST(LocalMap, AfterTheAnchorHasMovedThePlanesAreWhereTheyWere) {
  LocalMap map({}, kNoise);
  map.insert(plane_points(Vector3d::UnitZ(), kMiddle(), 100, 1), {}, kSeenFrom());
  const auto before = map.find(0, kMiddle().cast<float>());
  const Vector3d centre = (before.corner + before.surface->center).cast<double>() + map.anchor();
  map.follow({-50, 10, 5});
  EXPECT_GT(map.anchor().norm(), 10);
  const auto after = map.find(0, (kMiddle() - map.anchor()).cast<float>());
  ASSERT_NE(after.surface, nullptr);
  EXPECT_LT(((after.corner + after.surface->center).cast<double>() + map.anchor() - centre).norm(),
            1e-5);
}

TEST(LocalMap, AFullCellNoLongerFollowsItsPoints) {
  LocalMap map({}, kNoise);
  map.insert(plane_points(Vector3d::UnitZ(), kMiddle(), 400, 1), {}, kSeenFrom());
  const map::Surface before = *map.find(0, kMiddle().cast<float>()).surface;
  map.insert(plane_points(Vector3d::UnitZ(), kMiddle() + Vector3d(0, 0, 0.01), 400, 2), {},
             kSeenFrom());
  EXPECT_EQ(map.find(0, kMiddle().cast<float>()).surface->center, before.center);
}

TEST(LocalMap, OnALongWayMemoryStaysAndOnlyTheSurroundingsAreKept) {
  LocalMap map({}, kNoise);
  const std::size_t bytes = map.memory_bytes();
  EXPECT_LE(bytes, 60U << 20);
  RandomStream random(1, "way");
  std::size_t most = 0;
  for (int step = 0; step < 3000; ++step) {
    const SE3 T{Eigen::Quaterniond::Identity(), {3.0 * step, 0, 0}};
    std::vector<Vector3f> points;
    for (int i = 0; i < 300; ++i) {
      points.emplace_back(static_cast<float>(random.uniform(-50, 50)),
                          static_cast<float>(random.uniform(-50, 50)), 0.0F);
    }
    map.follow(T.translation);
    map.insert(points, T, Vector3d::Zero());
    most = std::max(most, map.cells(0));
  }
  EXPECT_EQ(map.memory_bytes(), bytes);
  EXPECT_EQ(map.refused(), 0U);
  // The stripe of 100 m width that lies within reach, and as much as is swept late.
  EXPECT_LT(most, 4 * 200 * 100 * 2U);
  EXPECT_EQ(map.find(0, Vector3f(-5000, 0.1F, 0.1F)).surface, nullptr);
}

TEST(LocalMap, WhereThereIsNoRoomNearerCellsAreForgottenToo) {
  LocalMapConfig config;
  config.cell_m = 0.1;
  config.radius_m = 300;
  LocalMap map(config, kNoise);
  RandomStream random(1, "crowded");
  for (int step = 0; step < 800; ++step) {
    std::vector<Vector3f> points;
    for (int i = 0; i < 1000; ++i) {
      points.emplace_back(static_cast<float>(random.uniform(-100, 100)),
                          static_cast<float>(random.uniform(-100, 100)), 0.0F);
    }
    map.follow(Vector3d::Zero());
    map.insert(points, {}, Vector3d::Zero());
  }
  // What was near has its place.
  const auto refused = map.refused();
  map.insert({{0.01F, 0.01F, 0}}, {}, Vector3d::Zero());
  EXPECT_EQ(map.refused(), refused);
}

TEST(CellTable, HoldsWhatWasPutInAndNothingElse) {
  CellTable table;
  table.reset(1000);
  std::vector<std::uint32_t> model(4000, CellTable::kNone);
  RandomStream random(7, "keys");
  const auto key = [](std::size_t i) {
    const int k = static_cast<int>(i);
    return cell_key({k % 16 - 8, k / 16 % 16 - 8, k / 256});
  };
  std::size_t held = 0;
  for (std::uint32_t step = 0; step < 40000; ++step) {
    const auto i = static_cast<std::size_t>(random.uniform(0, 3999.999));
    if (model[i] != CellTable::kNone) {
      table.erase(key(i));
      model[i] = CellTable::kNone;
      --held;
    } else if (held < 1000) {
      table.insert(key(i), step);
      model[i] = step;
      ++held;
    }
    const auto j = static_cast<std::size_t>(random.uniform(0, 3999.999));
    ASSERT_EQ(table.find(key(j)), model[j]);
  }
  for (std::size_t i = 0; i < model.size(); ++i) ASSERT_EQ(table.find(key(i)), model[i]);
}

TEST(CellTable, AKeyTellsItsCell) {
  for (const Eigen::Vector3i& cell : {Eigen::Vector3i(0, 0, 0), Eigen::Vector3i(-1, 5, -1048576),
                                      Eigen::Vector3i(1048575, -7, 3)}) {
    EXPECT_EQ(cell_of(cell_key(cell)), cell);
  }
}

}  // namespace
}  // namespace holdfast::odometry
