#include "holdfast/odometry/surroundings/local_pairing.hpp"

#include <gtest/gtest.h>

#include "holdfast/core/random.hpp"
#include "holdfast/registration/degeneracy.hpp"

namespace holdfast::odometry {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kNoise = 0.02;
constexpr double kSine = 0.3;

/// Points on the rectangle middle +- u +- v with noise across it.
void add_rectangle(const Vector3d& middle, const Vector3d& u, const Vector3d& v, int count,
                   std::uint64_t seed, std::vector<Vector3f>& points) {
  RandomStream random(seed, "rectangle");
  const Vector3d n = u.cross(v).normalized();
  for (int i = 0; i < count; ++i) {
    const Vector3d p = middle + random.uniform(-1, 1) * u + random.uniform(-1, 1) * v +
                       random.normal(0, kNoise) * n;
    points.push_back(p.cast<float>());
  }
}

registration::BodyPoints body_points(const std::vector<Vector3f>& points) {
  registration::BodyPoints body;
  body.points = points;
  body.age_s.assign(points.size(), 0.0F);
  return body;
}

/// A tunnel along x with nothing in it: floor, walls and ceiling, 20 m long, seen from its middle.
std::vector<Vector3f> tube(std::uint64_t seed) {
  const Vector3d x(10, 0, 0), y(0, 3, 0), z(0, 0, 2);
  std::vector<Vector3f> points;
  add_rectangle({0, 0, -1}, x, y, 15000, seed, points);
  add_rectangle({0, 0, 3}, x, y, 15000, seed + 1, points);
  add_rectangle({0, 3, 1}, x, z, 15000, seed + 2, points);
  add_rectangle({0, -3, 1}, x, z, 15000, seed + 3, points);
  return points;
}

struct Paired {
  LocalMap map{{}, kNoise};
  registration::Correspondences pairs;
  std::size_t count = 0;

  void pair(const std::vector<Vector3f>& scan, const SE3& T, bool settled = true) {
    WorkerPool pool(1);
    registration::AssociationOptions options;
    options.coarser_if_none = false;
    count = LocalPairing(map, kSine, settled)
                .associate(T, Vector3d::Zero(), body_points(scan), options, pool, pairs);
  }
  /// Information about the position along x, 1/m^2.
  double along_x(const SE3& T) const {
    WorkerPool pool(1);
    std::vector<registration::NormalEquations> partials;
    const auto e = registration::linearise(pairs, T, 3.0, pool, partials);
    return registration::position_information(e.H)(0, 0);
  }
};

TEST(LocalPairing, AThinPanelSeenFromBehindIsNotTheFaceThatWasSeenFromBefore) {
  Paired seen;
  std::vector<Vector3f> face;
  add_rectangle({5, 0, 0}, {0, 1, 0}, {0, 0, 1}, 2000, 1, face);
  seen.map.insert(face, {}, Vector3d::Zero());
  seen.pair(face, {});
  EXPECT_GT(seen.count, face.size() / 2);
  // From 10 m: its other face, 5 cm behind.
  const SE3 beyond{so3::exp({0, 0, M_PI}), {10, 0, 0}};
  std::vector<Vector3f> back;
  add_rectangle({4.95, 0, 0}, {0, 1, 0}, {0, 0, 1}, 2000, 2, back);
  seen.pair(back, beyond);
  EXPECT_EQ(seen.count, 0U);
}

/// What one line and a point or two beside it make of a floor: a plane that leans along the axis.
std::vector<Vector3f> leaning() {
  std::vector<Vector3f> points;
  for (int i = 0; i < 5; ++i)
    points.emplace_back(2.4F, -0.4F + 0.2F * static_cast<float>(i), -1.0F);
  points.emplace_back(2.6F, 0.0F, -0.92F);
  points.emplace_back(2.6F, 0.02F, -0.92F);
  return points;
}

TEST(LocalPairing, APlaneOfAHandfulOfPointsIsNoWitnessAlongATunnel) {
  Paired seen;
  std::vector<Vector3f> all = tube(1);
  // Where the floor was not seen yet, but for some points.
  std::erase_if(all, [](const Vector3f& p) {
    return p.z() < -0.5F && std::abs(p.x() - 2.5F) < 1.0F && std::abs(p.y()) < 1.5F;
  });
  const std::size_t bare = all.size();
  const auto few = leaning();
  all.insert(all.end(), few.begin(), few.end());
  seen.map.insert(all, {}, Vector3d::Zero());
  std::vector<Vector3f> scan = tube(11);
  for (int i = 0; i < 20; ++i)
    scan.emplace_back(2.4F, -0.4F + 0.04F * static_cast<float>(i), -1.0F);
  seen.pair(scan, {});
  ASSERT_GT(seen.count, bare / 2);
  // Nothing stands across this tunnel; what normals feign is below 1 / (0.1 m)^2.
  EXPECT_LT(seen.along_x({}), 100.0);
}

TEST(LocalPairing, AFaceAcrossATunnelIsAWitnessWorthNoMoreThanItself) {
  Paired seen;
  std::vector<Vector3f> all = tube(1);
  std::vector<Vector3f> face;
  add_rectangle({6.3, 2.5, 0.5}, {0, 0.4, 0}, {0, 0, 0.4}, 150, 5, face);
  all.insert(all.end(), face.begin(), face.end());
  seen.map.insert(all, {}, Vector3d::Zero());
  std::vector<Vector3f> scan = tube(11);
  add_rectangle({6.3, 2.5, 0.5}, {0, 0.4, 0}, {0, 0, 0.4}, 400, 6, scan);
  seen.pair(scan, {});
  const double sigma = 1.0 / std::sqrt(seen.along_x({}));
  EXPECT_LT(sigma, 0.010);  // it tells the axis
  // A surface is off by 3 mm (the least error of AssociationOptions) however many points it has;
  // this one fills at most four cells.
  EXPECT_GT(sigma, 0.003 / 2);
}

}  // namespace
}  // namespace holdfast::odometry
