#include "simulation/motion/route.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/tolerances.hpp"

namespace holdfast::simulation {
namespace {

constexpr double kPi = std::numbers::pi;

Route rectangle() { return Route::closed({{0, 0}, {10, 0}, {10, 4}, {0, 4}}, 1.0); }

TEST(Route, RoundsItsCornersByArcs) {
  const Route route = rectangle();
  EXPECT_NEAR(route.length(), 2 * (8 + 2) + 2 * kPi, 100 * tolerances::kEps * route.length());
}

TEST(Route, RunsThroughTheMiddlesOfItsSides) {
  const Route route = rectangle();
  const double first_middle = kPi / 2 + 4;  // it begins with the arc of the first corner
  const Route::Place place = route.at(first_middle);
  EXPECT_NEAR((place.position - Eigen::Vector3d(5, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(std::remainder(place.heading, 2 * kPi), 0, 1e-12);
  EXPECT_EQ(place.curvature, 0);
  EXPECT_NEAR(route.at(kPi / 2 + 8 + kPi / 4).curvature, 1, 1e-12);
}

TEST(Route, TellsWhereItsReversePassesAPlace) {
  const Route route = rectangle();
  const Route back = route.reversed();
  for (double s = -5; s < 2 * route.length(); s += 0.37) {
    const auto a = route.at(s);
    const auto b = back.at(route.reversed_s(s));
    ASSERT_NEAR((a.position - b.position).norm(), 0, 1e-12) << s;
    ASSERT_NEAR(std::remainder(a.heading - b.heading - kPi, 2 * kPi), 0, 1e-12) << s;
  }
}

TEST(Route, IsContinuousAndMovesAlongItsHeading) {
  for (const Route& route : {rectangle(), rectangle().reversed()}) {
    constexpr double kStep = 1e-3;
    for (double s = -5; s < 2 * route.length(); s += kStep) {
      const auto a = route.at(s);
      const auto b = route.at(s + kStep);
      const Eigen::Vector2d ahead(std::cos(a.heading), std::sin(a.heading));
      // A step along an arc of radius 1 leaves the tangent by step^2 / 2.
      ASSERT_NEAR(((b.position - a.position).head<2>() - kStep * ahead).norm(), 0,
                  0.51 * kStep * kStep + 1e-12);
      ASSERT_NEAR(b.heading - a.heading, 0, 1.001 * kStep);
    }
  }
}

TEST(Route, GoesRoundWithAHeadingThatGrows) {
  const Route route = rectangle();
  const auto once = route.at(1.0);
  const auto again = route.at(1.0 + route.length());
  EXPECT_NEAR((once.position - again.position).norm(), 0, 1e-12);
  EXPECT_NEAR(again.heading - once.heading, 2 * kPi, 1e-12);
  EXPECT_NEAR(route.reversed().at(route.length()).heading - route.reversed().at(0).heading,
              -2 * kPi, 1e-12);
}

TEST(Route, ShortensArcsThatDoNotFit) {
  const Route route = Route::closed({{0, 0}, {10, 0}, {10, 1}, {0, 1}}, 3.0);
  EXPECT_NEAR(route.length(), 2 * 9 + kPi, 1e-9);  // arcs of half a metre
}

TEST(Route, ClimbsBetweenCornersOfDifferentHeight) {
  const Route route =
      Route::closed({{{0, 0, 0}, 1}, {{10, 0, 0}, 1}, {{10, 20, 2}, 1}, {{0, 20, 2}, 1}});
  double highest = 0;
  double last = route.at(0).position.z();
  for (double s = 0; s < route.length(); s += 0.01) {
    const auto place = route.at(s);
    ASSERT_NEAR(place.position.z() - last, 0, 0.01 * 0.2);
    last = place.position.z();
    highest = std::max(highest, last);
  }
  EXPECT_NEAR(highest, 2, 1e-9);
}

}  // namespace
}  // namespace holdfast::simulation
