#include "holdfast/odometry/edges/edge_reference.hpp"

#include <gtest/gtest.h>

#include "holdfast/core/random.hpp"

namespace holdfast::odometry {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using filter::FilterState;
using filter::Matrix15d;

const Vector3d kGravity(0, 0, -9.81);
constexpr TimeNs kRevolution = kSecond / 10;

/// Upright edges along a street, each seen by three beams, by a robot that stands at `x`.
struct Street {
  Scan scan;
  filter::SelectedScan selected;

  Street() {
    scan.end_time = kRevolution;
    selected.scan = &scan;
    selected.imu.samples = {{0, Vector3d::Zero(), -kGravity},
                            {kRevolution, Vector3d::Zero(), -kGravity}};
  }

  std::vector<SeenEdge> seen_from(double x, std::uint64_t seed, int edges = 30) const {
    RandomStream places(1, "places");
    RandomStream noise(seed, "noise");
    std::vector<SeenEdge> seen;
    for (int edge = 0; edge < edges; ++edge) {
      const double place = places.uniform(-20, 20), side = edge % 2 == 0 ? 6 : -6;
      for (int beam = 0; beam < 3; ++beam) {
        ScanPoint p;
        p.x = static_cast<float>(place - x + 0.01 * noise.normal());
        p.y = static_cast<float>(side + 0.01 * noise.normal());
        p.z = 0.3F * static_cast<float>(beam);
        seen.push_back({p, Vector3f::UnitZ(), 0.01F});
      }
    }
    return seen;
  }
};

/// A robot that knows itself to a millimetre but for the way along the street, whose error each
/// scan grows by 0.2 m.
struct Robot {
  EdgeReference reference;
  FilterState state;
  Matrix15d now_before = Matrix15d::Zero();

  Robot() {
    state.t = kRevolution;
    state.P = 1e-6 * Matrix15d::Identity();
  }

  /// Goes on by `believed`, and looks at `street` from `x`.
  void go(double believed, const Street& street, double x, std::uint64_t seed) {
    const Matrix15d before = state.P;
    state.T_map_body.translation.x() += believed;
    state.P(FilterState::kP, FilterState::kP) += 0.04;
    now_before = before;  // all else stays as it is
    reference.follow(before, state.P, now_before);
    look(street, x, seed);
  }

  void look(const Street& street, double x, std::uint64_t seed) {
    reference.correct(street.seen_from(x, seed), street.selected, kGravity, state, now_before);
  }

  double x() const { return state.T_map_body.translation.x(); }
  double sigma_x() const { return std::sqrt(state.P(FilterState::kP, FilterState::kP)); }
};

TEST(EdgeReference, HoldsTheWayThatThePlanesLeaveOpen) {
  const Street street;
  Robot robot;
  robot.look(street, 0, 2);
  EXPECT_EQ(robot.x(), 0) << "nothing to be held against yet";
  for (int scan = 1; scan <= 5; ++scan) {
    const double x = 0.8 * scan;
    robot.go(0.88, street, x, 2 + static_cast<std::uint64_t>(scan));
    EXPECT_NEAR(robot.x(), x, 0.01) << "scan " << scan;
    EXPECT_NEAR(robot.state.T_map_body.translation.y(), 0, 0.003);
    EXPECT_LT(robot.sigma_x(), 0.02);
  }
}

/// The reference was seen once: however many scans meet it, its error of 1 cm stays in the way.
TEST(EdgeReference, WhatAllScansHaveInCommonIsNotAveragedAway) {
  const Street street;
  Robot robot;
  robot.look(street, 0, 2);
  for (std::uint64_t scan = 1; scan <= 100; ++scan) robot.go(0, street, 0, 2 + scan);
  EXPECT_GT(robot.sigma_x(), 0.01);
  EXPECT_LT(robot.sigma_x(), 0.015);
}

/// Between two scans the same reference's error cancels.
TEST(EdgeReference, TheStepBetweenTwoScansIsKnownBetterThanTheWay) {
  const Street street;
  Robot robot;
  robot.look(street, 0, 2);
  for (std::uint64_t scan = 1; scan <= 20; ++scan) {
    const double before = robot.state.P(0, 0);
    robot.go(0.88, street, 0.8 * static_cast<double>(scan), 2 + scan);
    const double step = before + robot.state.P(0, 0) - 2 * robot.now_before(0, 0);
    EXPECT_GT(step, 0);
    if (scan == 1) continue;
    // Both edges' common centimetres, and nothing of the reference's.
    EXPECT_NEAR(std::sqrt(step), std::sqrt(2.0) * 0.01, 0.003) << scan;
  }
}

TEST(EdgeReference, ACorrelatedVelocityFollows) {
  const Street street;
  Robot robot;
  robot.look(street, 0, 2);
  const Matrix15d before = robot.state.P;
  robot.state.T_map_body.translation.x() = 0.88;
  robot.state.P(FilterState::kP, FilterState::kP) = 0.04;
  robot.state.P(FilterState::kV, FilterState::kV) = 4.0;
  robot.state.P(FilterState::kV, FilterState::kP) = 0.39;
  robot.state.P(FilterState::kP, FilterState::kV) = 0.39;
  robot.now_before = before;
  robot.reference.follow(before, robot.state.P, robot.now_before);
  robot.look(street, 0.8, 3);
  // The position was 0.08 m too far on, and the speed is wrong by 0.39 / 0.04 of that.
  EXPECT_NEAR(robot.state.v_map.x(), -0.78, 0.15);
  EXPECT_LT(robot.state.P(FilterState::kV, FilterState::kV), 1.0);
}

TEST(EdgeReference, AScanThatHasLittleInCommonCorrectsNothingAndIsTheNextReference) {
  const Street street;
  Robot robot;
  robot.look(street, 0, 2);
  // Round a corner: nothing of what was seen is here.
  robot.go(300, street, 0, 3);
  EXPECT_EQ(robot.x(), 300);
  robot.go(0.85, street, 0.8, 4);
  EXPECT_NEAR(robot.x(), 300.8, 0.01);
  robot.reference.clear();
  const double last = robot.x();
  robot.go(0.85, street, 1.6, 5);
  EXPECT_EQ(robot.x(), last + 0.85);
}

}  // namespace
}  // namespace holdfast::odometry
