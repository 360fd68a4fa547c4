#include "holdfast/registration/degeneracy.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "holdfast/core/random.hpp"

namespace holdfast::registration {
namespace {

using Eigen::Vector3d;

constexpr double kSigma = 0.02;      // of each distance, m
constexpr double kWeakSigma = 0.05;  // a direction known worse than this is weak
constexpr double kUnbounded = 3.0;   // robust scale; the residuals are zero

/// Noise-free pairs of a body at the origin with surfaces in closed form.
class Scene {
 public:
  void add(const Vector3d& point, const Vector3d& normal) {
    const std::size_t i = pairs_.size();
    pairs_.resize(i + 1);
    pairs_.px[i] = static_cast<float>(point.x());
    pairs_.py[i] = static_cast<float>(point.y());
    pairs_.pz[i] = static_cast<float>(point.z());
    pairs_.nx[i] = static_cast<float>(normal.x());
    pairs_.ny[i] = static_cast<float>(normal.y());
    pairs_.nz[i] = static_cast<float>(normal.z());
    pairs_.offset[i] = static_cast<float>(normal.dot(point));
    pairs_.information[i] = static_cast<float>(1.0 / (sigma_ * sigma_));
    pairs_.age_s[i] = 0;
  }

  /// Points on the sides of a box across the axes asked for, `n` a side.
  void add_box(const Vector3d& half, const std::string& axes, int n = 200) {
    for (const char name : axes) {
      const int axis = name - 'x';
      for (int i = 0; i < 2 * n; ++i) {
        Vector3d p;
        for (int k = 0; k < 3; ++k) p[k] = random_.uniform(-half[k], half[k]);
        p[axis] = i % 2 == 0 ? half[axis] : -half[axis];
        add(p, Vector3d::Unit(axis));
      }
    }
  }

  NormalEquations equations() const {
    WorkerPool pool(1);
    std::vector<NormalEquations> partials;
    NormalEquations e = linearise(pairs_, SE3{}, kUnbounded, pool, partials);
    e.feigned = feigned_information(e, pairs_, SE3{}, kUnbounded, few_pairs_);
    return e;
  }
  Matrix9d H() const { return equations().H; }
  std::vector<Vector3d> weak() const { return weak_directions(equations(), kWeakSigma); }

  double sigma_ = kSigma;
  double few_pairs_ = 0;

 private:
  Correspondences pairs_;
  RandomStream random_{1, "degeneracy"};
};

TEST(WeakDirections, AClosedRoomHasNone) {
  Scene room;
  room.add_box({4, 3, 1.5}, "xyz");
  EXPECT_TRUE(room.weak().empty());
}

TEST(WeakDirections, ACorridorWithoutEndsHasItsAxis) {
  Scene corridor;
  corridor.add_box({20, 1.5, 1.2}, "yz");
  const auto weak = corridor.weak();
  ASSERT_EQ(weak.size(), 1U);
  EXPECT_NEAR(std::abs(weak[0].x()), 1, 1e-9);
}

TEST(WeakDirections, AFewPointsOnTheEndsOfACorridorDetermineItsAxis) {
  Scene corridor;
  corridor.add_box({20, 1.5, 1.2}, "yz");
  corridor.add_box({20, 1.5, 1.2}, "x", 10);
  EXPECT_TRUE(corridor.weak().empty());
}

TEST(FewToldDirections, AreThoseThatHardlyAnyPointFaces) {
  Scene corridor;
  corridor.add_box({20, 1.5, 1.2}, "yz");
  corridor.add_box({20, 1.5, 1.2}, "x", 9);
  const auto few = few_told_directions(corridor.equations());
  ASSERT_EQ(few.size(), 1U) << "a twentieth of what the walls get";
  EXPECT_NEAR(std::abs(few[0].x()), 1, 1e-6);
  Scene room;
  room.add_box({4, 3, 1.5}, "xyz");
  EXPECT_TRUE(few_told_directions(room.equations()).empty());
}

/// Nothing depends on the roll about the axis either: the rotation's own information is singular.
TEST(WeakDirections, ARoundTunnelHasItsAxis) {
  Scene tunnel;
  for (int i = 0; i < 600; ++i) {
    const double angle = 2 * std::numbers::pi * i / 600;
    const Vector3d normal(0, std::cos(angle), std::sin(angle));
    tunnel.add(3 * normal + Vector3d((i * 37 % 41) - 20, 0, 0), normal);
  }
  const auto weak = tunnel.weak();
  ASSERT_EQ(weak.size(), 1U);
  EXPECT_NEAR(std::abs(weak[0].x()), 1, 1e-6);
}

TEST(WeakDirections, AnOpenPlaneHasTwo) {
  Scene field;
  field.add_box({20, 20, 0}, "z");
  const auto weak = field.weak();
  ASSERT_EQ(weak.size(), 2U);
  for (const Vector3d& direction : weak) EXPECT_NEAR(direction.z(), 0, 1e-6);
}

TEST(WeakDirections, WithoutPointsAllAreWeak) {
  EXPECT_EQ(weak_directions(NormalEquations{}, kWeakSigma).size(), 3U);
}

/// 40 points a side across x at a sigma of 0.02 m tell x to 0.0022 m; at 0.6 m only to 0.067 m.
TEST(WeakDirections, TheLimitIsALengthAndNotANumberOfPoints) {
  Scene precise, coarse;
  coarse.sigma_ = 0.6;
  for (Scene* scene : {&precise, &coarse}) {
    scene->add_box({4, 3, 1.5}, "yz", 2000);
    scene->add_box({4, 3, 1.5}, "x", 40);
  }
  EXPECT_TRUE(precise.weak().empty());
  const auto weak = coarse.weak();
  ASSERT_EQ(weak.size(), 1U);
  EXPECT_GT(std::abs(weak[0].x()), 0.999);
}

/// On one side wall, seen far ahead only, a turn looks like a step sideways: at 20 m +- 1 m the
/// free rotation leaves sigma_y = 20 / 1 * sqrt(3) * sigma / sqrt(n) of the position.
TEST(PositionInformation, IsWhatIsLeftWhenTheRotationIsFree) {
  Scene wall;
  constexpr int kPoints = 4000;
  double sum = 0, squares = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double x = 19 + 2 * (i + 0.5) / kPoints;
    sum += x;
    squares += x * x;
    wall.add({x, 2, 0}, Vector3d::UnitY());
  }
  // Regression of n residuals on [1, x]: information of the constant is (n - sum^2 / squares).
  const double expected = (kPoints - sum * sum / squares) / (kSigma * kSigma);
  const Eigen::Matrix3d information = position_information(wall.H());
  // Products of floats of relative error 6e-8 cancel to 1 / 1200 of their size.
  EXPECT_NEAR(information(1, 1), expected, 0.01 * expected);
  EXPECT_LT(information(1, 1), 0.001 * wall.H()(1, 1));
}

TEST(FeignedOffset, IsSmallWhereEveryDirectionIsHeld) {
  Scene room;
  room.add_box({3, 2, 1.5}, "xyz");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> offset(feigned_offset(room.equations()));
  const double scan = 1.0 / position_information(room.H()).diagonal().minCoeff();
  EXPECT_LT(offset.eigenvalues()[2], 1e-3 * scan);
}

TEST(FeignedOffset, LeavesNothingOfWhatTiltedNormalsTellOfTheAxisOfACorridor) {
  RandomStream random(1, "tilts");
  Scene corridor;
  for (int i = 0; i < 4000; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const Vector3d normal = Vector3d(0.003 * random.normal(), side, 0.003 * random.normal());
    corridor.add({random.uniform(-20, 20), 1.5 * side, random.uniform(-1, 1)}, normal.normalized());
    const Vector3d up = Vector3d(0.003 * random.normal(), 0, side);
    corridor.add({random.uniform(-20, 20), random.uniform(-1.5, 1.5), side}, up.normalized());
  }
  // The tilts alone seem to tell the axis to within a decimetre.
  EXPECT_GT(position_information(corridor.H())(0, 0), 100.0);
  EXPECT_GT(feigned_offset(corridor.equations())(0, 0), 50.0);
  EXPECT_LT(feigned_offset(corridor.equations())(1, 1), 1e-6);
}

/// Four pairs on the ends of a corridor tell its axis to 0.02 / sqrt(4) m. Where twenty are needed
/// to prove a direction, that counts for 1 / (1 + (20/4)^2) of its information; a thousand of them
/// lose next to nothing.
TEST(FeignedInformation, OfAFewPairsIsMostOfIt) {
  for (const auto& [pairs, share] : {std::pair(2, 25.0 / 26.0), std::pair(500, 0.0)}) {
    Scene corridor;
    corridor.few_pairs_ = 20;
    corridor.sigma_ = 0.3;  // tilts of the normals feign nothing worth speaking of
    corridor.add_box({20, 1.5, 1.2}, "yz", 20000);
    corridor.sigma_ = kSigma;
    corridor.add_box({20, 1.5, 1.2}, "x", pairs);
    const NormalEquations e = corridor.equations();
    const double seeming = position_information(e.H)(0, 0);
    EXPECT_NEAR(seeming, 2 * pairs / (kSigma * kSigma), 0.02 * seeming);
    EXPECT_NEAR(e.feigned(0, 0) / seeming, share, 0.02) << pairs << " pairs on each end";
  }
}

}  // namespace
}  // namespace holdfast::registration
