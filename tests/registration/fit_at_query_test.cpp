#include "holdfast/registration/fit_at_query.hpp"

#include <gtest/gtest.h>

#include "tests/map/built_map.hpp"
#include "tests/map/clouds.hpp"

namespace holdfast::registration {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

const Vector3d kHalf(4, 3, 1.5);  // of a room around the origin

/// One point in each `spacing` on the sides of the room, away from its edges, and on its edges,
/// with noise.
FeatureClouds room(double spacing, double sigma, std::uint64_t seed) {
  RandomStream random(seed, "room");
  FeatureClouds clouds;
  for (int axis = 0; axis < 3; ++axis) {
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      const Vector3d corner = side * kHalf[axis] * Vector3d::Unit(axis) -
                              0.95 * kHalf[b] * Vector3d::Unit(b) -
                              0.95 * kHalf[c] * Vector3d::Unit(c);
      map::testing::add_patch(corner, 1.9 * kHalf[b] * Vector3d::Unit(b),
                              1.9 * kHalf[c] * Vector3d::Unit(c), random, clouds.planes, spacing,
                              sigma);
      for (const double other : {-1.0, 1.0}) {
        const Vector3d middle =
            side * kHalf[axis] * Vector3d::Unit(axis) + other * kHalf[b] * Vector3d::Unit(b);
        for (double u = -kHalf[c]; u < kHalf[c]; u += spacing) {
          const Vector3d p = middle + u * Vector3d::Unit(c) + map::testing::noise(random, sigma);
          clouds.edges.push_back(p.cast<float>());
        }
      }
    }
  }
  return clouds;
}

/// The room as seen by a body at `T_map_body`.
FeatureClouds seen(const FeatureClouds& map, const SE3& T_map_body) {
  FeatureClouds scan;
  const SE3 T = T_map_body.inverse();
  for (const Vector3f& p : map.edges) scan.edges.push_back((T * p.cast<double>()).cast<float>());
  for (const Vector3f& p : map.planes) scan.planes.push_back((T * p.cast<double>()).cast<float>());
  return scan;
}

double error_m(const FitAtQueryResult& found, const SE3& truth) {
  return (found.T_map_body.translation - truth.translation).norm();
}

const SE3 kTruth{so3::exp({0.02, -0.03, 0.8}), {0.6, -0.5, 0.1}};

SE3 off_by(const Vector3d& shift, const Vector3d& turn) {
  return {kTruth.rotation * so3::exp(turn), kTruth.translation + shift};
}

TEST(FitAtQuery, FindsANoiseFreeRoomToAMillimetre) {
  const FitAtQuery registration(room(0.1, 0, 1));
  const FeatureClouds scan = seen(room(0.3, 0, 2), kTruth);
  for (const Vector3d& shift : {Vector3d(0.1, 0, 0), Vector3d(-0.2, 0.2, 0.1)}) {
    const auto found = registration.align(scan, off_by(shift, {0.02, 0, 0.05}));
    EXPECT_TRUE(found.valid);
    EXPECT_TRUE(found.converged);
    // Near a corner, points of the next edge or side enter a fit: a share of 0.3 m / 3 m of them.
    EXPECT_LT(error_m(found, kTruth), 1e-3);
    EXPECT_LT(found.mean_abs_edge_m, 1e-2);
    EXPECT_LT(found.mean_abs_plane_m, 1e-3);
  }
}

/// 2 cm on some thousand points against planes and lines of 5 mm: about a millimetre.
TEST(FitAtQuery, FindsANoisyRoomToMillimetresAndReportsAbsoluteMeans) {
  const FitAtQuery registration(room(0.1, 0.005, 1));
  const auto found =
      registration.align(seen(room(0.3, 0.02, 2), kTruth), off_by({0.2, -0.1, 0.1}, {0, 0, 0.05}));
  EXPECT_TRUE(found.valid);
  EXPECT_LT(error_m(found, kTruth), 0.005);
  EXPECT_LT(so3::angle_between(found.T_map_body.rotation, kTruth.rotation), 0.002);
  // The mean of |x| is 0.8 sigma, which signed residuals would cancel.
  EXPECT_NEAR(found.mean_abs_plane_m, 0.8 * 0.02, 0.2 * 0.02);
  EXPECT_GT(found.mean_abs_edge_m, 0.8 * 0.02);
}

/// Edges alone hold all six unknowns; so the derivative of the line residual is right.
TEST(FitAtQuery, EdgesAloneDetermineThePose) {
  FitAtQueryConfig config;
  config.least_planes = 0;
  const FitAtQuery registration(room(0.1, 0, 1), config);
  FeatureClouds scan = seen(room(0.3, 0, 2), kTruth);
  scan.planes.clear();
  const auto found = registration.align(scan, off_by({0.1, -0.1, 0.05}, {0.01, 0.02, -0.03}));
  EXPECT_TRUE(found.converged);
  EXPECT_LT(error_m(found, kTruth), 1e-3);
}

TEST(FitAtQuery, IsInvalidWithFewerThanTenEdgesOrTwentyPlanes) {
  const FitAtQuery registration(room(0.1, 0.005, 1));
  const SE3 start = off_by({0.05, 0, 0}, {0, 0, 0.01});
  for (const auto& [edges, planes, valid] :
       {std::tuple{10, 20, true}, std::tuple{9, 20, false}, std::tuple{10, 19, false}}) {
    FeatureClouds all = seen(room(0.3, 0, 2), kTruth), scan;
    for (int i = 0; i < edges; ++i) scan.edges.push_back(all.edges[i * 31 % all.edges.size()]);
    for (int i = 0; i < planes; ++i) scan.planes.push_back(all.planes[i * 61 % all.planes.size()]);
    const auto found = registration.align(scan, start);
    EXPECT_EQ(found.valid, valid) << edges << " edges, " << planes << " planes";
    if (!valid) {
      EXPECT_EQ(found.T_map_body.translation, start.translation);
    }
  }
}

TEST(FitAtQuery, BeyondTheRadiiNothingMatches) {
  const FitAtQuery registration(room(0.1, 0.005, 1));
  const auto found = registration.align(seen(room(0.3, 0, 2), kTruth),
                                        {Eigen::Quaterniond::Identity(), {100, 0, 0}});
  EXPECT_FALSE(found.valid);
  EXPECT_EQ(found.edges + found.planes, 0);
}

TEST(FitAtQuery, WithoutAMapIsInvalid) {
  EXPECT_FALSE(FitAtQuery({}).align(seen(room(0.3, 0, 2), kTruth), kTruth).valid);
}

double distance_to_room_edge(const Vector3d& p) {
  const Vector3d d = (p.cwiseAbs() - kHalf).cwiseAbs();
  return std::min({std::hypot(d.x(), d.y()), std::hypot(d.y(), d.z()), std::hypot(d.z(), d.x())});
}

TEST(ClassifyPoints, SplitsASurveyIntoEdgesAndPlanes) {
  RandomStream random(1, "survey");
  io::PointCloud cloud;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d u = 2 * kHalf[(axis + 1) % 3] * Vector3d::Unit((axis + 1) % 3);
    const Vector3d v = 2 * kHalf[(axis + 2) % 3] * Vector3d::Unit((axis + 2) % 3);
    map::testing::add_patch(-kHalf, u, v, random, cloud.points);
    map::testing::add_patch(-kHalf + 2 * kHalf[axis] * Vector3d::Unit(axis), u, v, random,
                            cloud.points);
  }
  const std::size_t n = cloud.points.size();
  const map::testing::BuiltMap built(std::move(cloud));
  const auto clouds = classify_points(built.path());
  ASSERT_TRUE(clouds) << clouds.error().message;
  EXPECT_GT(static_cast<double>(clouds->planes.size()), 0.8 * static_cast<double>(n));
  EXPECT_GT(clouds->edges.size(), 400U);  // of 52 m of edges, with points 6 cm apart
  std::size_t on_edge = 0, far = 0;
  for (const Vector3f& p : clouds->edges) {
    on_edge += distance_to_room_edge(built.info().origin + p.cast<double>()) < 0.15;
  }
  for (const Vector3f& p : clouds->planes) {
    far += distance_to_room_edge(built.info().origin + p.cast<double>()) > 0.05;
  }
  EXPECT_GT(static_cast<double>(on_edge), 0.99 * static_cast<double>(clouds->edges.size()));
  EXPECT_GT(static_cast<double>(far), 0.97 * static_cast<double>(clouds->planes.size()));
}

TEST(ClassifyPoints, OfAFolderWithoutAMapIsAnErrorThatNamesIt) {
  const auto clouds = classify_points("/nowhere/map");
  ASSERT_FALSE(clouds);
  EXPECT_NE(clouds.error().message.find("/nowhere/map"), std::string::npos);
}

}  // namespace
}  // namespace holdfast::registration
