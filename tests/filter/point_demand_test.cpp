#include "holdfast/filter/matching/point_demand.hpp"

#include <gtest/gtest.h>

namespace holdfast::filter {
namespace {

/// Tells each axis of the position as well as a scan of so many points does, of which all tell y
/// and z, and a few x.
registration::NormalEquations told_by(double points, double sigma_x_of_usual) {
  constexpr double kUsual = 8000;
  registration::NormalEquations e;
  e.H.setZero();
  const double share = points / kUsual;
  e.H(0, 0) = share / (sigma_x_of_usual * sigma_x_of_usual);
  e.H(1, 1) = e.H(2, 2) = share / (0.001 * 0.001);
  return e;
}

int points_after(const registration::NormalEquations& told, std::size_t matched) {
  const preprocess::ScanSelectionConfig usual;
  PointDemand demand;
  EXPECT_EQ(demand.next(usual).max_points, usual.max_points) << "at first the usual number";
  demand.learn(told, matched, usual);
  return demand.next(usual).max_points;
}

TEST(PointDemand, IsMoreWhileADirectionIsPoorlyKnown) {
  const preprocess::ScanSelectionConfig usual;
  EXPECT_EQ(points_after(told_by(8000, 0.009), 8000), usual.max_points);
  EXPECT_EQ(points_after(told_by(8000, 0.011), 8000), usual.most_points);
}

/// Else every second scan would be matched with many points, and the others with few.
TEST(PointDemand, StaysWhereTheUsualNumberWouldNotDo) {
  const preprocess::ScanSelectionConfig usual;
  EXPECT_EQ(points_after(told_by(32000, 0.0055), 32000), usual.most_points);
  EXPECT_EQ(points_after(told_by(32000, 0.0045), 32000), usual.max_points);
}

/// A scan that has hardly returns is no reason to ask less of it.
TEST(PointDemand, OfAScanWithFewPointsIsJudgedByWhatItTold) {
  const preprocess::ScanSelectionConfig usual;
  EXPECT_EQ(points_after(told_by(1000, 0.003), 1000), usual.max_points);
  EXPECT_EQ(points_after(told_by(1000, 0.005), 1000), usual.most_points);
}

TEST(PointDemand, IsNeverLessThanTheUsualNumber) {
  preprocess::ScanSelectionConfig many;
  many.max_points = 50000;
  PointDemand demand;
  demand.learn(told_by(50000, 1.0), 50000, many);
  EXPECT_EQ(demand.next(many).max_points, 50000);
}

}  // namespace
}  // namespace holdfast::filter
