#include "holdfast/filter/scan_update.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "tests/filter/box_room.hpp"

namespace holdfast::filter {
namespace {

using namespace testing;

constexpr double kDegree = std::numbers::pi / 180;

UpdateOptions options() {
  UpdateOptions o;
  o.association.range_sigma_m = static_cast<float>(kRangeSigma);
  o.association.surface_sigma_m = 0.004F;
  o.max_iterations = 20;
  return o;
}

/// A pose error of 0.2 m and 3 degrees that the prior allows for.
FilterState prior_off_by(const Scene& s, const Vector3d& shift, const Vector3d& turn) {
  FilterState state;
  state.t = s.scan.end_time;
  state.T_map_body = {(s.truth.rotation * so3::exp(turn)).normalized(),
                      s.truth.translation + shift};
  state.v_map = s.v_map;
  state.P.setZero();
  const auto set = [&](int offset, double sigma) {
    state.P.diagonal().segment<3>(offset).setConstant(sigma * sigma);
  };
  set(FilterState::kP, 0.2);
  set(FilterState::kR, 3 * kDegree);
  set(FilterState::kV, 0.1);
  set(FilterState::kBa, 0.05);
  set(FilterState::kBg, 0.01);
  return state;
}

void expect_same_bits(const FilterState& a, const FilterState& b) {
  EXPECT_EQ(a.T_map_body.translation, b.T_map_body.translation);
  EXPECT_EQ(a.T_map_body.rotation.coeffs(), b.T_map_body.rotation.coeffs());
  EXPECT_EQ(a.v_map, b.v_map);
  EXPECT_EQ(a.accel_bias, b.accel_bias);
  EXPECT_EQ(a.gyro_bias, b.gyro_bias);
  EXPECT_EQ(a.P, b.P);
}

class InARoom : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    built = std::make_unique<map::testing::BuiltMap>(small_room().survey());
  }
  static void TearDownTestSuite() { built.reset(); }

  UpdateResult update(const Scene& s, FilterState& state, const UpdateOptions& o, int threads = 1) {
    WorkerPool pool(threads);
    const FilterState prior = state;
    return update_with_scan(map, s.selected, kGravity, o, pool, work, prior, state, nullptr);
  }

  static std::unique_ptr<map::testing::BuiltMap> built;
  map::PriorMap map = focused(*built);
  UpdateWorkspace work;
  SE3 middle{so3::exp({0.02, -0.01, 0.7}), {0.4, 0.3, 0.9}};
};
std::unique_ptr<map::testing::BuiltMap> InARoom::built;

// Thousands of points with 20 mm noise tell each coordinate to about 0.5 mm; the map's own noise of
// 5 mm, in planes of some 200 points, is common to points of a cell and leaves about as much. Five
// standard deviations of both.
constexpr double kFoundM = 5 * 0.7e-3;
// A millimetre over half of the room's extent.
constexpr double kFoundRad = 5 * 0.7e-3 / 3;

TEST_F(InARoom, ThePoseIsFoundFromAFifthOfAMetreAndThreeDegrees) {
  const auto s = scene(small_room(), middle, Vector3d::Zero());
  RandomStream random(1, "starts");
  for (int k = 0; k < 10; ++k) {
    const Vector3d shift =
        0.2 * Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    const Vector3d turn =
        3 * kDegree * Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    FilterState state = prior_off_by(*s, shift, turn);
    const UpdateResult result = update(*s, state, options());
    EXPECT_TRUE(result.usable);
    EXPECT_LT(position_error(state, s->truth), kFoundM) << "draw " << k;
    EXPECT_LT(angle_error(state, s->truth), kFoundRad) << "draw " << k;
    EXPECT_GT(result.equations.weight, 0.6 * static_cast<double>(s->scan.points.size()));
  }
}

TEST_F(InARoom, TheErrorIsWhatTheCovarianceSays) {
  // Over scans with other noise; the map is the same, so its error is in the mean.
  double squares = 0;
  constexpr int kScans = 20;
  for (std::uint64_t seed = 1; seed <= kScans; ++seed) {
    const auto s = scene(small_room(), middle, Vector3d::Zero(), seed);
    FilterState state = prior_off_by(*s, {0.02, -0.02, 0.02}, {0.002, 0.002, -0.002});
    UpdateOptions o = options();
    o.map_sigma_m = 0.001;
    ASSERT_TRUE(update(*s, state, o).usable);
    const Vector3d error = state.T_map_body.translation - s->truth.translation;
    const Eigen::Matrix3d P = state.P.block<3, 3>(FilterState::kP, FilterState::kP);
    squares += error.dot(P.ldlt().solve(error));
  }
  // NEES of three coordinates: 3 on average. The map's error does not average out over scans, hence
  // not the chi-square bound but a factor of three in standard deviations, to both sides.
  EXPECT_LT(squares / kScans, 3 * 9.0);
  EXPECT_GT(squares / kScans, 3 / 9.0);
}

TEST_F(InARoom, TheCovarianceShrinksInEveryDirection) {
  const auto s = scene(small_room(), middle, Vector3d::Zero());
  FilterState state = prior_off_by(*s, {0.05, 0.05, 0.05}, {0.01, 0.01, 0.01});
  const Matrix15d before = state.P;
  ASSERT_TRUE(update(*s, state, options()).usable);
  EXPECT_EQ(state.P, state.P.transpose());
  // Information was added: P before less P after has no negative eigenvalue. The chart of the
  // rotation turns by the change of the rotation (0.02 rad), which is all that it may differ by.
  const Eigen::SelfAdjointEigenSolver<Matrix15d> gained(before - state.P);
  EXPECT_GT(gained.eigenvalues()[0], -0.04 * before(FilterState::kR, FilterState::kR));
  const Eigen::SelfAdjointEigenSolver<Matrix15d> left(state.P);
  EXPECT_GT(left.eigenvalues()[0], 0);
  EXPECT_LT(state.P.topLeftCorner(3, 3).trace(), 3 * 0.005 * 0.005);
}

TEST_F(InARoom, TheMapsOwnErrorBoundsWhatOneScanCanTell) {
  const auto s = scene(small_room(), middle, Vector3d::Zero());
  UpdateOptions o = options();
  o.map_sigma_m = 0.01;
  FilterState state = prior_off_by(*s, {0, 0, 0}, {0, 0, 0});
  ASSERT_TRUE(update(*s, state, o).usable);
  for (int i = 0; i < 3; ++i) {
    // 1 / (1 / 0.01^2 + 1 / 0.2^2): the prior of 0.2 m helps a little.
    EXPECT_GT(std::sqrt(state.P(i, i)), 0.01 * 0.998);
    EXPECT_LT(std::sqrt(state.P(i, i)), 0.011);
  }
}

TEST_F(InARoom, AnEmptyScanIsNotUsableAndChangesNothing) {
  auto s = scene(small_room(), middle, Vector3d::Zero());
  s->scan.points.clear();
  s->selected.selected.clear();
  FilterState state = prior_off_by(*s, {0.1, 0, 0}, {0, 0, 0});
  const FilterState before = state;
  EXPECT_FALSE(update(*s, state, options()).usable);
  expect_same_bits(state, before);
}

TEST_F(InARoom, AScanOfAnotherPlaceIsNotUsable) {
  const auto s = scene(small_room(), middle, Vector3d::Zero());
  FilterState state = prior_off_by(*s, {300, 200, 0}, {0, 0, 0});
  EXPECT_FALSE(update(*s, state, options()).usable);
}

TEST_F(InARoom, ASkewedScanIsUnskewedByTheKnownVelocity) {
  const auto s = scene(small_room(), middle, {1.5, -0.8, 0});
  FilterState state = prior_off_by(*s, {0.05, 0.02, -0.02}, {0.01, 0, 0.02});
  ASSERT_TRUE(update(*s, state, options()).usable);
  EXPECT_LT(position_error(state, s->truth), kFoundM);
  EXPECT_LT(angle_error(state, s->truth), kFoundRad);
}

TEST_F(InARoom, TheVelocityFollowsFromTheSkewWhereThatIsAsked) {
  const auto s = scene(small_room(), middle, {1.5, -0.8, 0});
  FilterState state = prior_off_by(*s, {0.05, 0.02, -0.02}, {0.01, 0, 0.02});
  state.v_map.setZero();
  state.P.diagonal().segment<3>(FilterState::kV).setConstant(4.0);
  UpdateOptions o = options();
  o.velocity_from_skew = true;
  ASSERT_TRUE(update(*s, state, o).usable);
  EXPECT_LT(position_error(state, s->truth), 5 * std::sqrt(state.P.topLeftCorner(3, 3).trace()));
  const Eigen::Matrix3d P_v = state.P.block<3, 3>(FilterState::kV, FilterState::kV);
  EXPECT_LT((state.v_map - s->v_map).norm(), 5 * std::sqrt(P_v.trace()));
  // Half a scan against the other half, 0.05 s apart, each good to a millimetre or two.
  EXPECT_LT(std::sqrt(P_v.trace()), 0.1);
}

TEST_F(InARoom, WithoutThatTheVelocityIsLeftToThePrediction) {
  const auto s = scene(small_room(), middle, Vector3d::Zero());
  FilterState state = prior_off_by(*s, {0, 0, 0}, {0, 0, 0});
  const Vector3d v = state.v_map;
  ASSERT_TRUE(update(*s, state, options()).usable);
  // No correlation in the prior, so nothing moves it.
  EXPECT_LT((state.v_map - v).norm(), 1e-9);
}

TEST_F(InARoom, BitsDoNotDependOnTheNumberOfThreads) {
  const auto s = scene(small_room(), middle, {0.5, 0.2, 0});
  FilterState one = prior_off_by(*s, {0.1, -0.05, 0.02}, {0.01, 0.02, 0.03});
  FilterState two = one;
  ASSERT_TRUE(update(*s, one, options(), 1).usable);
  ASSERT_TRUE(update(*s, two, options(), 2).usable);
  expect_same_bits(one, two);
}

TEST_F(InARoom, AFewWalkersDoNotMoveThePose) {
  auto s = scene(small_room(), middle, Vector3d::Zero());
  for (std::size_t i = 0; i < s->scan.points.size(); ++i) {
    // Two sectors of 20 degrees see something at 1.5 m.
    const std::size_t column = i / 16;
    if (column % 225 >= 25) continue;
    ScanPoint& p = s->scan.points[i];
    const float shrink = 1.5F / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    p.x *= shrink;
    p.y *= shrink;
    p.z *= shrink;
  }
  FilterState state = prior_off_by(*s, {0.1, -0.05, 0.02}, {0.01, 0.02, 0.03});
  ASSERT_TRUE(update(*s, state, options()).usable);
  EXPECT_LT(position_error(state, s->truth), kFoundM);
  EXPECT_LT(angle_error(state, s->truth), kFoundRad);
}

}  // namespace
}  // namespace holdfast::filter
