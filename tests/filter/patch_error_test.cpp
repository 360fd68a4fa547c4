#include "holdfast/filter/matching/patch_error.hpp"

#include <gtest/gtest.h>

#include "holdfast/core/random.hpp"
#include "holdfast/registration/normal_equations.hpp"

namespace holdfast::filter {
namespace {

using Eigen::Vector3f;

constexpr float kNoise = 0.005F;
constexpr double kWide = 1e6;  // of the robust loss: no point counts less than another

/// The middles of walls all around, 5 m away, seen by a body at the origin.
struct Walls {
  PatchModel model{.noise_m = kNoise};
  registration::Correspondences pairs;
  RandomStream random{1, "walls"};

  /// `count` pairs within 0.8 m on the wall towards `n`, which is `thickness_m` thick.
  void add(const Vector3f& n, int count, float thickness_m) {
    const float range = model.range_sigma_m;
    for (int i = 0; i < count; ++i) {
      const Vector3f aside = 0.4F * Vector3f(uniform(), uniform(), uniform());
      const Vector3f p = 5.0F * n + aside - n * n.dot(aside) + Vector3f(0.45F, 0.45F, 0.45F);
      const float offset = n.dot(p);
      const float cosine_sq = std::pow(n.dot(p), 2.0F) / p.squaredNorm();
      const std::size_t k = pairs.size();
      pairs.resize(k + 1);
      pairs.px[k] = p.x(), pairs.py[k] = p.y(), pairs.pz[k] = p.z();
      pairs.nx[k] = n.x(), pairs.ny[k] = n.y(), pairs.nz[k] = n.z();
      pairs.offset[k] = offset;
      pairs.information[k] = 1.0F / (range * range * cosine_sq + thickness_m * thickness_m +
                                     model.surface_sigma_m * model.surface_sigma_m);
    }
  }

  Matrix6d error() {
    WorkerPool pool(1);
    std::vector<registration::NormalEquations> partials;
    const auto e = registration::linearise(pairs, {}, kWide, pool, partials);
    PatchError patches;
    return patches.of(pairs, {}, kWide, e.H.topLeftCorner<6, 6>(), model);
  }

 private:
  float uniform() { return static_cast<float>(random.uniform(-1, 1)); }
};

/// Its standard error, whatever the number of points: along x two walls share the weight.
TEST(PatchError, OfThickWallsIsTheirsHoweverManyPointsSeeThem) {
  constexpr float kThickness = 0.013F;
  const double excess = std::pow(kThickness, 2) - std::pow(kNoise, 2);
  for (const int count : {50, 1000}) {
    Walls walls;
    for (const float side : {-1.0F, 1.0F}) walls.add({side, 0, 0}, count, kThickness);
    walls.add({0, 1, 0}, count, kThickness);
    walls.add({0, 0, 1}, count, kThickness);
    const Matrix6d C = walls.error();
    EXPECT_NEAR(C(0, 0) / (excess / 2), 1.0, 0.1) << count;
    EXPECT_NEAR(C(1, 1) / excess, 1.0, 0.1) << count;
    EXPECT_NEAR(C(2, 2) / excess, 1.0, 0.1) << count;
  }
}

TEST(PatchError, OfWallsAsThinAsTheirNoiseIsNone) {
  Walls walls;
  for (const float side : {-1.0F, 1.0F}) {
    for (int axis = 0; axis < 3; ++axis) walls.add(side * Vector3f::Unit(axis), 100, kNoise);
  }
  EXPECT_LT(walls.error().topLeftCorner(3, 3).norm(), 1e-9);
}

TEST(PatchError, IsScaledByItsShare) {
  Walls walls;
  for (int axis = 0; axis < 3; ++axis) walls.add(Vector3f::Unit(axis), 100, 0.02F);
  const Matrix6d whole = walls.error();
  walls.model.share = 0.5;
  EXPECT_LT((walls.error() - 0.25 * whole).norm(), 1e-9 * whole.norm());
}

}  // namespace
}  // namespace holdfast::filter
