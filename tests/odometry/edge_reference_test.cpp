#include "holdfast/odometry/edges/edge_reference.hpp"

#include <gtest/gtest.h>

#include "holdfast/core/random.hpp"

namespace holdfast::odometry {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using filter::FilterState;

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

/// Known to a millimetre but for the way along the street, to 0.2 m.
FilterState state_at(double x) {
  FilterState state;
  state.t = kRevolution;
  state.T_map_body.translation.x() = x;
  state.P = 1e-6 * filter::Matrix15d::Identity();
  state.P(FilterState::kP, FilterState::kP) = 0.04;
  return state;
}

TEST(EdgeReference, HoldsTheWayThatThePlanesLeaveOpen) {
  const Street street;
  EdgeReference reference;
  FilterState first = state_at(0);
  reference.correct(street.seen_from(0, 2), street.selected, kGravity, first);
  EXPECT_EQ(first.T_map_body.translation.x(), 0) << "nothing to be held against yet";
  for (int scan = 1; scan <= 5; ++scan) {
    const double x = 0.8 * scan;
    FilterState state = state_at(x + 0.08);
    reference.correct(street.seen_from(x, 2 + static_cast<std::uint64_t>(scan)), street.selected,
                      kGravity, state);
    // 90 edges of 1 cm, seen twice: 1.5 mm; a hundredth of the prior, too.
    EXPECT_NEAR(state.T_map_body.translation.x(), x, 0.01) << "scan " << scan;
    EXPECT_NEAR(state.T_map_body.translation.y(), 0, 0.003);
    const double sigma = std::sqrt(state.P(FilterState::kP, FilterState::kP));
    EXPECT_LT(sigma, 0.05);
    EXPECT_GT(sigma, 0.01) << "ten scans count for one, of a centimetre in common";
  }
}

TEST(EdgeReference, ACorrelatedVelocityFollows) {
  const Street street;
  EdgeReference reference;
  FilterState first = state_at(0);
  reference.correct(street.seen_from(0, 2), street.selected, kGravity, first);
  FilterState state = state_at(0.88);
  state.P(FilterState::kV, FilterState::kV) = 4.0;
  state.P(FilterState::kV, FilterState::kP) = state.P(FilterState::kP, FilterState::kV) = 0.39;
  reference.correct(street.seen_from(0.8, 3), street.selected, kGravity, state);
  // The position was 0.08 m too far on, and the speed is wrong by 0.39 / 0.04 of that.
  EXPECT_NEAR(state.v_map.x(), -0.78, 0.15);
  EXPECT_LT(state.P(FilterState::kV, FilterState::kV), 1.0);
}

TEST(EdgeReference, AScanThatHasLittleInCommonCorrectsNothingAndIsTheNextReference) {
  const Street street;
  EdgeReference reference;
  FilterState first = state_at(0);
  reference.correct(street.seen_from(0, 2), street.selected, kGravity, first);
  // Round a corner: nothing of what was seen is here.
  FilterState far = state_at(300);
  reference.correct(street.seen_from(0, 3), street.selected, kGravity, far);
  EXPECT_EQ(far.T_map_body.translation.x(), 300);
  FilterState next = state_at(300.85);
  reference.correct(street.seen_from(0.8, 4), street.selected, kGravity, next);
  EXPECT_NEAR(next.T_map_body.translation.x(), 300.8, 0.01);
  reference.clear();
  FilterState again = state_at(301.7);
  reference.correct(street.seen_from(1.6, 5), street.selected, kGravity, again);
  EXPECT_EQ(again.T_map_body.translation.x(), 301.7);
}

}  // namespace
}  // namespace holdfast::odometry
