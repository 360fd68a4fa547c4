#include "holdfast/registration/point_to_line.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "holdfast/core/random.hpp"
#include "holdfast/registration/levenberg_marquardt.hpp"
#include "holdfast/registration/normal_equations.hpp"

namespace holdfast::registration {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// The edges of a cage of 4 x 3 x 2 m around the origin, each in a cell of its own: stands in for a
/// map.
class Cage {
 public:
  struct Hit {
    const map::Surface* surface = nullptr;
    Vector3f corner = Vector3f::Zero();
  };

  Cage() {
    for (int axis = 0; axis < 3; ++axis) {
      for (const float b : {-1.0F, 1.0F}) {
        for (const float c : {-1.0F, 1.0F}) {
          map::Surface line{};
          line.kind = map::SurfaceKind::kLine;
          line.center = Vector3f::Zero();
          line.center[(axis + 1) % 3] = b * half_[(axis + 1) % 3];
          line.center[(axis + 2) % 3] = c * half_[(axis + 2) % 3];
          line.normal = Vector3f::Unit(axis);
          line.sigma_m = 0.004F;
          lines_.push_back(line);
        }
      }
    }
  }

  Hit find(int, const Vector3f& p) const {
    for (const map::Surface& line : lines_) {
      if ((p - line.center).cross(line.normal).norm() < 0.4F) return {&line};
    }
    return {};
  }

  /// Points on the lines away from their ends, in the frame of a body at `T`.
  BodyPoints points(const SE3& T) const {
    BodyPoints points;
    for (const map::Surface& line : lines_) {
      for (int k = -5; k <= 5; ++k) {
        const Vector3f p = line.center + 0.1F * static_cast<float>(k) * line.normal;
        points.points.push_back((T.inverse() * p.cast<double>()).cast<float>());
        points.age_s.push_back(0);
      }
    }
    return points;
  }

  std::vector<map::Surface> lines_;

 private:
  Vector3f half_{2.0F, 1.5F, 1.0F};
};

/// As `associate` leaves them where no point has found a plane.
Correspondences without_planes(const BodyPoints& points) {
  Correspondences pairs;
  pairs.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    pairs.px[i] = points.points[i].x();
    pairs.py[i] = points.points[i].y();
    pairs.pz[i] = points.points[i].z();
  }
  return pairs;
}

Vector3f normal_of(const Correspondences& pairs, std::size_t i) {
  return {pairs.nx[i], pairs.ny[i], pairs.nz[i]};
}

TEST(LinePair, IsTwoPlanesThroughTheLineWhoseSquaresAddUpToTheDistance) {
  RandomStream random(1, "lines");
  const auto any = [&] { return Vector3d(random.normal(), random.normal(), random.normal()); };
  for (int k = 0; k < 100; ++k) {
    const Vector3f direction = any().normalized().cast<float>();
    const LineMatch line{any().cast<float>(), direction, 0.004F, true};
    const Vector3f q = any().cast<float>();
    Correspondences pairs;
    append_line_pair(line, q, -0.05F, any().cast<float>(), {}, pairs);
    ASSERT_EQ(pairs.size(), 2U);
    const Vector3f a = normal_of(pairs, 0), b = normal_of(pairs, 1);
    EXPECT_NEAR(a.dot(b), 0, 1e-5);
    EXPECT_NEAR(a.dot(direction), 0, 1e-5);
    EXPECT_NEAR(b.dot(direction), 0, 1e-5);
    const float ra = a.dot(q) - pairs.offset[0], rb = b.dot(q) - pairs.offset[1];
    EXPECT_NEAR(std::hypot(ra, rb), (q - line.point).cross(direction).norm(), 1e-5);
    EXPECT_EQ(pairs.age_s[1], -0.05F);
  }
}

/// Seen square to the line a range error shows in full along the ray, and never aside.
TEST(LinePair, RangeErrorsCountAlongTheRayOnly) {
  AssociationOptions options;
  options.range_sigma_m = 0.02F;
  options.surface_sigma_m = 0.003F;
  const float least = 0.004F * 0.004F + 0.003F * 0.003F;
  const LineMatch upright{Vector3f::Zero(), Vector3f::UnitZ(), 0.004F, true};
  Correspondences pairs;
  append_line_pair(upright, Vector3f::Zero(), 0, {5, 0, 0}, options, pairs);
  EXPECT_NEAR(pairs.information[0], 1 / (least + 0.0004F), 1e-4 * pairs.information[0]);
  EXPECT_NEAR(pairs.information[1], 1 / least, 1e-4 * pairs.information[1]);
  EXPECT_NEAR(std::abs(pairs.nx[0]), 1, 1e-6);
  append_line_pair(upright, Vector3f::Zero(), 0, {0, 0, 5}, options, pairs);
  EXPECT_NEAR(pairs.information[2], 1 / least, 1e-4 * pairs.information[2]);
}

TEST(LinePairs, OfACageDetermineThePose) {
  const Cage cage;
  const SE3 truth{so3::exp({0.1, -0.05, 0.6}), {0.2, 0.1, -0.1}};
  const BodyPoints points = cage.points(truth);
  SE3 pose = moved(truth, (Vector6d() << 0.1, -0.08, 0.05, 0.02, -0.01, 0.04).finished());
  WorkerPool pool(1);
  std::vector<NormalEquations> partials;
  for (int k = 0; k < 10; ++k) {
    Correspondences pairs = without_planes(points);
    EXPECT_EQ(add_line_pairs(cage, pose, Vector3d::Zero(), points, {}, pairs), points.size());
    EXPECT_EQ(pairs.size(), 3 * points.size());
    const NormalEquations e = linearise(pairs, pose, 1e3, pool, partials);
    pose = moved(pose, -e.H.topLeftCorner<6, 6>().ldlt().solve(e.g.head<6>()));
  }
  // Float coordinates of some metres are good to 5e-7 m.
  EXPECT_LT((pose.translation - truth.translation).norm(), 1e-5);
  EXPECT_LT(so3::angle_between(pose.rotation, truth.rotation), 1e-5);
}

TEST(LinePairs, PointsWithAPlaneAndPointsOutOfTheGateGetNone) {
  const Cage cage;
  const BodyPoints points = cage.points({});
  Correspondences pairs = without_planes(points);
  for (float& information : pairs.information) information = 1;
  EXPECT_EQ(add_line_pairs(cage, {}, Vector3d::Zero(), points, {}, pairs), 0U);
  EXPECT_EQ(pairs.size(), points.size());
  pairs = without_planes(points);
  const SE3 off{Eigen::Quaterniond::Identity(), {0.22, 0.22, 0.22}};  // 0.31 m from each line
  EXPECT_EQ(add_line_pairs(cage, off, Vector3d::Zero(), points, {}, pairs), 0U);
}

TEST(LinePairs, BetweenTwoLinesOfOneCellNothingIsChosen) {
  Cage cage;
  cage.lines_.resize(2);
  cage.lines_[0].more = 1;
  cage.lines_[1].center = cage.lines_[0].center + Vector3f(0, 0.1F, 0);
  EXPECT_FALSE(nearest_line(cage, 0, cage.lines_[0].center, 0.3F).found);
  EXPECT_TRUE(nearest_line(cage, 0, cage.lines_[0].center, 0.05F).found);
}

}  // namespace
}  // namespace holdfast::registration
