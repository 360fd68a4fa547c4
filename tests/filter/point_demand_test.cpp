#include "holdfast/filter/matching/point_demand.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

struct Demand {
  preprocess::ScanSelectionConfig usual;
  PointDemand demand;

  int points_after(const registration::NormalEquations& told, std::size_t matched) {
    demand.learn(told, matched, usual);
    return demand.next(usual).max_points;
  }
};

TEST(PointDemand, IsTheUsualNumberAtFirst) {
  const preprocess::ScanSelectionConfig usual;
  EXPECT_EQ(PointDemand().next(usual).max_points, usual.max_points);
}

TEST(PointDemand, IsMoreWhileADirectionIsPoorlyKnown) {
  Demand tunnel;
  EXPECT_EQ(tunnel.points_after(told_by(8000, 0.009), 8000), tunnel.usual.max_points);
  EXPECT_EQ(tunnel.points_after(told_by(8000, 0.011), 8000), tunnel.usual.most_points);
}

/// Else every second scan would be matched with many points, and the others with few.
TEST(PointDemand, StaysWhereTheUsualNumberWouldNotDo) {
  Demand tunnel;
  tunnel.points_after(told_by(8000, 0.011), 8000);
  EXPECT_EQ(tunnel.points_after(told_by(32000, 0.0055), 32000), tunnel.usual.most_points);
  EXPECT_EQ(tunnel.points_after(told_by(32000, 0.0045), 32000), tunnel.usual.max_points);
}

/// The usual number of a scan is what it was matched with: fewer returns, or a share of many.
TEST(PointDemand, OfAScanIsJudgedByWhatItTold) {
  for (const std::size_t matched : {std::size_t{1000}, std::size_t{30000}}) {
    const auto points = static_cast<double>(matched);
    Demand demand;
    const double as_one_cm = 0.01 * std::sqrt(points / 8000);
    EXPECT_EQ(demand.points_after(told_by(points, 0.9 * as_one_cm), matched),
              demand.usual.max_points);
    EXPECT_EQ(demand.points_after(told_by(points, 1.1 * as_one_cm), matched),
              demand.usual.most_points);
  }
}

TEST(PointDemand, IsNeverLessThanTheUsualNumber) {
  Demand many;
  many.usual.max_points = 50000;
  EXPECT_EQ(many.points_after(told_by(50000, 1.0), 50000), 50000);
}

}  // namespace
}  // namespace holdfast::filter
