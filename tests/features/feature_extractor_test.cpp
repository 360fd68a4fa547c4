#include <gtest/gtest.h>

#include "holdfast/features/features.hpp"
#include "tests/features/ray_scene.hpp"

namespace holdfast::features {
namespace {

using namespace testing;

constexpr double kNearEdgeM = 0.15;

Features extract(const Scan& scan, double sigma = kRangeSigma) {
  FeatureExtractor extractor(FeatureConfig{}, sigma);
  Features found;
  extractor.extract(scan, found);
  return found;
}

double angle_deg(const Vector3f& a, const Vector3d& b) {
  return std::acos(std::min(1.0, std::abs(a.cast<double>().dot(b)))) * 180 / M_PI;
}

/// The rectangle that a scan's point lies on.
int surface_of(const RayScene& scene, const ScanPoint& p) {
  double range = 0;
  return scene.hit(point_of(p).cast<double>().normalized(), range);
}

TEST(FittedFeatures, EdgesOfAFurnishedRoomLieOnItsEdges) {
  const RayScene scene = furnished_room();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Features found = extract(scene.scan(seed));
    std::size_t right = 0;
    for (const Feature& edge : found.edges) {
      right += scene.distance_to_edge(edge.position.cast<double>()) < kNearEdgeM;
    }
    // Two or three corners of the pillar and four of the room, which 10 rings see between floor and
    // ceiling; the column hides one of them.
    EXPECT_GT(found.edges.size(), 50U);
    EXPECT_GT(static_cast<double>(right), 0.9 * static_cast<double>(found.edges.size()));
  }
}

TEST(FittedFeatures, NormalsOfARoomAreThoseOfItsSides) {
  const RayScene scene = furnished_room();
  const Scan scan = scene.scan(1);
  const Features found = extract(scan);
  std::size_t within = 0;
  for (const Feature& plane : found.planes) {
    EXPECT_NEAR(plane.axis.norm(), 1, 1e-5);
    EXPECT_LT(plane.axis.dot(plane.position), 0);
    const int surface = surface_of(scene, scan.points[plane.index]);
    within += surface >= 0 && angle_deg(plane.axis, scene.rectangles[surface].normal()) < 5.0;
  }
  EXPECT_GT(found.planes.size(), 2000U);
  EXPECT_GT(static_cast<double>(within), 0.97 * static_cast<double>(found.planes.size()));
}

/// Positions are averages over the window: their errors along the normal are as sigma_m says.
TEST(FittedFeatures, SigmaIsTheErrorOfThePosition) {
  const RayScene scene = room();
  const Scan scan = scene.scan(1);
  double whitened = 0, most_sigma = 0;
  const Features found = extract(scan);
  for (const Feature& plane : found.planes) {
    const Rectangle& side = scene.rectangles[surface_of(scene, scan.points[plane.index])];
    const double off = side.normal().dot(plane.position.cast<double>() - side.corner);
    whitened += off * off / (plane.sigma_m * plane.sigma_m);
    most_sigma = std::max(most_sigma, static_cast<double>(plane.sigma_m));
  }
  whitened /= static_cast<double>(found.planes.size());
  EXPECT_GT(whitened, 0.3);
  EXPECT_LT(whitened, 1.5);
  EXPECT_LT(most_sigma, kRangeSigma);
}

TEST(FittedFeatures, WallCornersPointUpwards) {
  const RayScene scene = room();
  std::size_t corners = 0, upright = 0;
  for (const Feature& edge : extract(scene.scan(1)).edges) {
    const Vector3d p = edge.position.cast<double>();
    const bool low_or_high = p.z() < -0.5 || p.z() > 1.7;  // floor and ceiling meet the walls there
    if (low_or_high || scene.distance_to_edge(p) > kNearEdgeM) continue;
    ++corners;
    upright += std::abs(edge.axis.z()) > std::cos(0.3);
  }
  EXPECT_GT(corners, 20U);
  EXPECT_GT(static_cast<double>(upright), 0.9 * static_cast<double>(corners));
}

/// A wall to one side of the LiDAR, from y0 to y1 at x = 4, 6 m high.
Rectangle wall(double x, double y0, double y1) { return {{x, y0, -3}, {0, y1 - y0, 0}, {0, 0, 6}}; }

TEST(FittedFeatures, ABareWallHasNoEdgeEvenAtItsEndsAgainstNothing) {
  RayScene scene;
  scene.rectangles.push_back(wall(4, -3, 3));
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Features found = extract(scene.scan(seed));
    EXPECT_TRUE(found.edges.empty());
    EXPECT_GT(found.planes.size(), 500U);
  }
}

TEST(FittedFeatures, WhereAFaceHidesAWallTheFaceHasTheEdgeAndTheWallHasNone) {
  RayScene scene;
  scene.rectangles.push_back(wall(8, -8, 8));
  scene.rectangles.push_back(wall(4, -1, 1));
  const Features found = extract(scene.scan(1));
  EXPECT_GE(found.edges.size(), 16U);
  for (const Feature& edge : found.edges) {
    EXPECT_NEAR(edge.position.x(), 4, 0.1);
    EXPECT_NEAR(std::abs(edge.position.y()), 1, 0.05);
  }
}

TEST(FittedFeatures, AHoleInTheReturnsIsNoEdge) {
  RayScene scene;
  scene.rectangles.push_back(wall(4, -3, -0.5));
  scene.rectangles.push_back(wall(4, 0.5, 3));
  EXPECT_TRUE(extract(scene.scan(1)).edges.empty());
}

TEST(FittedFeatures, ARoundColumnHasFewEdges) {
  RayScene scene;
  scene.rectangles.push_back(wall(8, -8, 8));
  scene.cylinders.push_back({3, 0, 0.25});
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Scan scan = scene.scan(seed);
    const Features found = extract(scan);
    // 16 rings pass it; by its silhouette and its turn each could see three edges. At a noise of a
    // twelfth of its radius some arcs cannot be told from corners.
    EXPECT_LE(found.edges.size(), 16U);
  }
}

/// A step of 1 sigma cannot be seen, one of 10 cm must not pass as flat.
TEST(FittedFeatures, AStepInAWallIsNoPlane) {
  RayScene scene;
  scene.rectangles.push_back(wall(4, -3, 0));
  scene.rectangles.push_back(wall(4.1, 0, 3));
  for (const Feature& plane : extract(scene.scan(1)).planes) {
    EXPECT_GT(std::abs(plane.position.y()), 0.1);
  }
}

TEST(FittedFeatures, WithoutRingsAreTheSame) {
  const RayScene scene = furnished_room();
  Scan scan = scene.scan(1);
  const Features with = extract(scan);
  scan.has_ring = false;
  for (ScanPoint& p : scan.points) p.ring = 0;
  const Features without = extract(scan);
  const auto alike = [](std::size_t a, std::size_t b) {
    return std::abs(static_cast<double>(a) / static_cast<double>(b) - 1) < 0.05;
  };
  // The rows begin elsewhere, and each beginning and end costs a window.
  EXPECT_TRUE(alike(without.planes.size(), with.planes.size()));
  EXPECT_TRUE(alike(without.edges.size(), with.edges.size()));
}

/// No beams: rays anywhere in a cone of 70 degrees.
TEST(FittedFeatures, OfASensorWithoutBeamsArePrecise) {
  const RayScene scene = furnished_room();
  RandomStream random(1, "rosette");
  std::vector<Vector3f> points;
  std::vector<int> surfaces;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d ray =
        Vector3d(1, random.uniform(-0.7, 0.7), random.uniform(-0.4, 0.4)).normalized();
    double range = 0;
    surfaces.push_back(scene.hit(ray, range));
    points.push_back(((range + random.normal(0, kRangeSigma)) * ray).cast<float>());
  }
  FeatureExtractor extractor(FeatureConfig{}, kRangeSigma);
  Features found;
  extractor.extract(points, {}, found);
  std::size_t planes = 0, edges = 0;
  for (const Feature& f : found.planes) {
    planes += angle_deg(f.axis, scene.rectangles[surfaces[f.index]].normal()) < 8.0;
  }
  for (const Feature& f : found.edges) {
    edges += scene.distance_to_edge(f.position.cast<double>()) < kNearEdgeM;
  }
  EXPECT_GT(found.planes.size(), 500U);
  EXPECT_GT(static_cast<double>(planes), 0.9 * static_cast<double>(found.planes.size()));
  EXPECT_GE(static_cast<double>(edges), 0.8 * static_cast<double>(found.edges.size()));
}

TEST(FittedFeatures, OfEmptyAndTinyScansAreNone) {
  for (const std::size_t n : {0UL, 1UL, 5UL, 20UL}) {
    Scan scan = room().scan(1);
    scan.points.resize(n);
    const Features found = extract(scan);
    EXPECT_TRUE(found.edges.empty() && found.planes.empty()) << n;
  }
}

TEST(FittedFeatures, DoNotDependOnTheScanBefore) {
  FeatureExtractor extractor(FeatureConfig{}, kRangeSigma);
  Features fresh = extract(room().scan(2)), used;
  extractor.extract(furnished_room().scan(1), used);
  extractor.extract(room().scan(2), used);
  ASSERT_EQ(fresh.planes.size(), used.planes.size());
  ASSERT_EQ(fresh.edges.size(), used.edges.size());
  for (std::size_t i = 0; i < used.planes.size(); ++i) {
    ASSERT_EQ(fresh.planes[i].axis, used.planes[i].axis);
  }
}

}  // namespace
}  // namespace holdfast::features
