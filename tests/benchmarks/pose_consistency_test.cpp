#include "benchmarks/harness/pose_consistency.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "holdfast/core/random.hpp"

namespace holdfast::benchmarks {
namespace {

using Error = PoseConsistency::Error;
using Covariance = PoseConsistency::Covariance;

/// A covariance with all six errors correlated.
Covariance correlated(RandomStream& random) {
  Covariance root;
  for (int i = 0; i < root.size(); ++i) root.data()[i] = random.normal();
  return root * root.transpose() + 0.1 * Covariance::Identity();
}

PoseConsistency drawn(double error_scale, int instants) {
  RandomStream random(7, "pose_consistency_test");
  PoseConsistency consistency;
  for (int i = 0; i < instants; ++i) {
    const Covariance P = correlated(random);
    Error white;
    for (int k = 0; k < 6; ++k) white[k] = random.normal();
    const Error error = P.llt().matrixL() * white;
    consistency.add(error_scale * error, P);
  }
  return consistency;
}

TEST(ChiSquare, BandIsThatOfTheTables) {
  EXPECT_NEAR(chi_square_band_95(6).low, 1.2373, 1e-4);
  EXPECT_NEAR(chi_square_band_95(6).high, 14.4494, 1e-4);
  EXPECT_NEAR(chi_square_band_95(60).low, 40.4817, 1e-4);
  EXPECT_NEAR(chi_square_band_95(60).high, 83.2977, 1e-4);
}

TEST(PoseConsistency, OfErrorsAsLargeAsTheirCovarianceIsOneInEachDimension) {
  constexpr int kInstants = 20000;
  const PoseConsistency c = drawn(1, kInstants);
  EXPECT_EQ(c.instants(), std::size_t{kInstants});
  const double sigma_of_mean = std::sqrt(2.0 / kInstants);  // of a square of one dimension
  for (int axis = 0; axis < 6; ++axis) EXPECT_NEAR(c.of_axis(axis), 1, 4 * sigma_of_mean);
  EXPECT_NEAR(c.of_position(), 1, 4 * sigma_of_mean / std::sqrt(3.0));
  EXPECT_NEAR(c.of_rotation(), 1, 4 * sigma_of_mean / std::sqrt(3.0));
  EXPECT_NEAR(c.of_pose(), 1, 4 * sigma_of_mean / std::sqrt(6.0));
  EXPECT_NEAR(c.share_in_band(), 0.95, 4 * std::sqrt(0.95 * 0.05 / kInstants));
}

TEST(PoseConsistency, OfErrorsTwiceAsLargeIsFour) {
  const PoseConsistency honest = drawn(1, 100);
  const PoseConsistency bold = drawn(2, 100);
  EXPECT_NEAR(bold.of_pose(), 4 * honest.of_pose(), 1e-9);
  EXPECT_NEAR(bold.of_axis(5), 4 * honest.of_axis(5), 1e-9);
  EXPECT_LT(bold.share_in_band(), 0.5);
}

TEST(PoseConsistency, OfTwoDrivesCountsEachInstantOnce) {
  PoseConsistency sum = drawn(1, 10);
  sum.add(drawn(2, 30));
  EXPECT_EQ(sum.instants(), 40U);
  EXPECT_NEAR(sum.of_pose(), (drawn(1, 10).of_pose() + 3 * drawn(2, 30).of_pose()) / 4, 1e-9);
}

TEST(PoseConsistency, OfNothingIsNotKnown) {
  EXPECT_TRUE(std::isnan(PoseConsistency().of_pose()));
  EXPECT_TRUE(std::isnan(PoseConsistency().of_axis(0)));
  EXPECT_TRUE(std::isnan(PoseConsistency().share_in_band()));
}

}  // namespace
}  // namespace holdfast::benchmarks
