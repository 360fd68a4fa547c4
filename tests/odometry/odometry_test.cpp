#include "holdfast/odometry/odometry.hpp"

#include <gtest/gtest.h>

#include "tests/filter/box_room.hpp"

namespace holdfast::odometry {
namespace {

using namespace filter::testing;

const Vector3d kAccelJump(0.2, -0.2, 0.1);    // m/s^2
const Vector3d kGyroJump(0.01, -0.02, 0.02);  // rad/s

/// A body that goes straight on, scan after scan, with its IMU: at an even velocity from the start
/// on, or from rest after a second, speeding up for another.
struct Journey {
  Box box = small_room();
  SE3 start{so3::exp({0.03, -0.02, 0.5}), {0.5, 0.4, 0.8}};  ///< T_map_body at the first scan's end
  Vector3d v_map = Vector3d::Zero();
  bool from_rest = false;
  int jump_at = 1 << 30;  ///< scan after which both biases have jumped
  std::uint64_t seed = 1;

  /// Seconds at full speed that the way up to `t` s after the first scan's end takes.
  double way_s(double t) const {
    if (!from_rest) return t;
    const double speeding = std::clamp(t - 1.0, 0.0, 1.0);
    return 0.5 * speeding * speeding + std::max(t - 2.0, 0.0);
  }
  SE3 at(double t) const { return {start.rotation, start.translation + way_s(t) * v_map}; }
  SE3 truth(int scan) const { return at(0.1 * scan); }

  Scan scan(int number, bool returns = true) const {
    const auto motion = [&](double age) { return at(0.1 * number - age); };
    Scan s = look_around(box, motion, some_extrinsic(), seed + static_cast<std::uint64_t>(number));
    s.stamp += kRevolution * number;
    s.end_time += kRevolution * number;
    if (!returns) s.points.clear();
    return s;
  }
  void feed_imu(Odometry& odometry, int number) const {
    for (int i = number == 0 ? 0 : 1; i <= 20; ++i) {
      const double t = 0.1 * number - 0.1 + 0.005 * i;
      const bool speeding = from_rest && t > 1.0 && t <= 2.0;
      const Vector3d a = speeding ? v_map : Vector3d(Vector3d::Zero());
      const double jumped = number > jump_at ? 1 : 0;
      odometry.add_imu({kStart + kRevolution * number + kRevolution * i / 20, jumped * kGyroJump,
                        start.rotation.conjugate() * (a - kGravity) + jumped * kAccelJump});
    }
  }
  OdometryReport step(Odometry& odometry, int number, bool returns = true) const {
    feed_imu(odometry, number);
    return odometry.add_scan(scan(number, returns));
  }
  /// Distance between the true and the estimated way since the first scan, in the body's frame.
  double error_m(const OdometryReport& report, const SE3& first, int number) const {
    const SE3 way = first.inverse() * report.step.T_map_body;
    return (way.translation - (start.inverse() * truth(number)).translation).norm();
  }
};

Odometry::Setup setup(int threads = 1) {
  Odometry::Setup s;
  s.imu = {1e-4, 3e-3, 1e-5, 1e-4};
  s.T_body_lidar = some_extrinsic();
  s.range_sigma_m = kRangeSigma;
  s.threads = threads;
  return s;
}

// Planes of a map made from scans with 20 mm noise, some hundred points each: a millimetre or two.
constexpr double kDriftM = 0.01;

TEST(Odometry, StartsAtTheOriginUprightWithTheHeadingOfTheBody) {
  const Journey rest;
  Odometry odometry(setup());
  const OdometryReport first = rest.step(odometry, 0);
  EXPECT_EQ(first.step.T_map_body.translation.norm(), 0);
  EXPECT_EQ(first.step.state, State::kTracking);
  EXPECT_FALSE(first.increment);
  const Eigen::Quaterniond R = first.step.T_map_body.rotation;
  // Up is where it is in truth.
  EXPECT_LT(
      (R.conjugate() * Vector3d::UnitZ() - rest.start.rotation.conjugate() * Vector3d::UnitZ())
          .norm(),
      1e-6);
  EXPECT_NEAR((R * Vector3d::UnitX()).y(), 0, 1e-9);
}

TEST(Odometry, ARestingRobotStaysWhereItIs) {
  const Journey rest;
  Odometry odometry(setup());
  const SE3 first = rest.step(odometry, 0).step.T_map_body;
  for (int k = 1; k < 30; ++k) {
    const OdometryReport report = rest.step(odometry, k);
    EXPECT_LT(rest.error_m(report, first, k), kDriftM) << "scan " << k;
    EXPECT_TRUE(report.corrected);
    EXPECT_FALSE(report.broke);
  }
}

/// A body that already moves when the log begins.
class AtSpeed : public ::testing::TestWithParam<double> {};

TEST_P(AtSpeed, TheWayIsThatOfTheTruthAlsoFromAStartOnTheMove) {
  Journey journey;
  journey.box = {{-6, -5, -0.1}, {14, 9, 3.1}};
  journey.v_map = GetParam() * Vector3d(0.8, 0.6, 0);
  Odometry odometry(setup());
  const SE3 first = journey.step(odometry, 0).step.T_map_body;
  OdometryReport report;
  const int scans = static_cast<int>(std::min(30.0, 60.0 / GetParam()));
  for (int k = 1; k < scans; ++k) {
    report = journey.step(odometry, k);
    EXPECT_FALSE(report.broke) << "scan " << k;
  }
  // The first two scans, moved at the velocity that they told, leave some millimetres more.
  EXPECT_LT(journey.error_m(report, first, scans - 1), 2 * kDriftM);
  EXPECT_NEAR(report.v_odom.norm(), GetParam(), 0.05);
}

INSTANTIATE_TEST_SUITE_P(MetresASecond, AtSpeed, ::testing::Values(0.2, 0.5, 1.5, 6.0));

/// In a room of 8 m a LiDAR that looks 15 degrees up and down hardly sees floor and ceiling.
class InASmallRoom : public ::testing::TestWithParam<double> {};

TEST_P(InASmallRoom, TheHeightFollowsNoNoiseAfterAStartOnTheMove) {
  // A climb of 4 cm/s, of which nothing tells, over less than 1.5 s.
  constexpr double kHeightM = 0.06;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    RandomStream random(seed, "where");
    const double yaw = random.uniform(-3, 3), heading = random.uniform(-3, 3);
    const double x = random.uniform(-1.8, 3.4), y = random.uniform(-1, 2.4);
    Journey journey;
    journey.start = {so3::exp({0.03, -0.02, yaw}), {x, y, 0.8}};
    journey.v_map = GetParam() * Vector3d(std::cos(heading), std::sin(heading), 0);
    journey.seed = 100 * seed;
    const auto is_inside = [&](int scan) {
      const Vector3d p = journey.truth(scan).translation;
      return p.x() > -2.4 && p.x() < 4.2 && p.y() > -1.5 && p.y() < 3.1;
    };
    if (!is_inside(4)) continue;
    Odometry odometry(setup());
    const SE3 first = journey.step(odometry, 0).step.T_map_body;
    for (int k = 1; k < 15 && is_inside(k); ++k) {
      const SE3 way = first.inverse() * journey.step(odometry, k).step.T_map_body;
      const double height = (journey.start.rotation * way.translation).z();
      EXPECT_LT(std::abs(height), kHeightM) << "scan " << k << ", seed " << seed;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(MetresASecond, InASmallRoom, ::testing::Values(0.2, 0.5, 1.2, 2.0, 6.0));

TEST(Odometry, IncrementsAreAsGoodAsTheySay) {
  double squares = 0, count = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Journey journey;
    journey.v_map = {0.5, 0.2, 0};
    journey.from_rest = true;
    journey.seed = 1000 * seed;
    Odometry odometry(setup());
    for (int k = 0; k < 50; ++k) {
      const OdometryReport report = journey.step(odometry, k);
      if (!report.increment || k < 5) continue;
      const SE3 truth = journey.truth(k - 1).inverse() * journey.truth(k);
      Eigen::Matrix<double, 6, 1> e;
      e << report.increment->T_prev_cur.translation - truth.translation,
          so3::log(truth.rotation.conjugate() * report.increment->T_prev_cur.rotation);
      squares += e.dot(report.increment->covariance.ldlt().solve(e));
      count += 6;
    }
  }
  EXPECT_GT(squares / count, 0.5);
  EXPECT_LT(squares / count, 2.0);
}

TEST(Odometry, ARobotThatWasCarriedAwayBreaksAndGoesOn) {
  Journey before;
  before.box = {{-6, -5, -0.1}, {14, 9, 3.1}};
  Journey after = before;
  after.start = {so3::exp({0.03, -0.02, 2.2}), {9.0, 5.5, 0.8}};
  Odometry odometry(setup());
  for (int k = 0; k < 20; ++k) EXPECT_EQ(before.step(odometry, k).step.odom_epoch, 0);
  int broke_at = -1;
  SE3 at_break;
  for (int k = 20; k < 40; ++k) {
    // Set down at once; the IMU felt nothing but the tilt that there is.
    const OdometryReport report = after.step(odometry, k);
    if (report.broke) {
      EXPECT_EQ(broke_at, -1);
      EXPECT_FALSE(report.increment);
      EXPECT_FALSE(report.step.reason.empty());
      broke_at = k;
      at_break = report.step.T_map_body;
    }
    if (k == 39) {
      EXPECT_EQ(report.step.odom_epoch, 1);
      EXPECT_LT((report.step.T_map_body.translation - at_break.translation).norm(), 2 * kDriftM);
      EXPECT_TRUE(report.corrected);
    }
  }
  EXPECT_GE(broke_at, 20);
  EXPECT_LE(broke_at, 25);
}

TEST(Odometry, AJumpOfTheBiasesIsFoundAndTheWayStaysRight) {
  Journey journey;
  journey.v_map = {0.5, 0.2, 0};
  journey.from_rest = true;
  journey.jump_at = 30;
  Odometry odometry(setup());
  const SE3 first = journey.step(odometry, 0).step.T_map_body;
  for (int k = 1; k < 60; ++k) {
    const OdometryReport report = journey.step(odometry, k);
    EXPECT_FALSE(report.broke);
    // A scan of a room of 8 m, turned by the jumped rate while it was taken, is bent by less.
    EXPECT_LT(journey.error_m(report, first, k), 2 * kDriftM) << "scan " << k;
  }
  // Over two seconds a bias of this size would have moved the way by as much.
  EXPECT_LT((odometry.state().gyro_bias - kGyroJump).norm(), 0.1 * kGyroJump.norm());
  EXPECT_LT((odometry.state().accel_bias - kAccelJump).norm(), 0.2 * kAccelJump.norm());
}

TEST(Odometry, BegunAnewItIsAsIfSwitchedOn) {
  const Journey rest;
  Odometry odometry(setup());
  for (int k = 0; k < 5; ++k) rest.step(odometry, k);
  const double before = odometry.gravity_sigma_rad();
  const int epoch = rest.step(odometry, 5).step.odom_epoch;
  odometry.begin_anew();
  const OdometryReport first = rest.step(odometry, 6);
  EXPECT_EQ(first.step.odom_epoch, epoch + 1);
  EXPECT_FALSE(first.increment);
  EXPECT_EQ(first.step.T_map_body.translation.norm(), 0);
  EXPECT_GT(odometry.gravity_sigma_rad(), 2 * before);
  for (int k = 7; k < 20; ++k) {
    const OdometryReport report = rest.step(odometry, k);
    EXPECT_LT(report.step.T_map_body.translation.norm(), kDriftM) << "scan " << k;
  }
}

TEST(Odometry, ABlackoutIsBridgedByTheImu) {
  Journey journey;
  journey.v_map = {0.5, 0.2, 0};
  journey.from_rest = true;
  Odometry odometry(setup());
  const SE3 first = journey.step(odometry, 0).step.T_map_body;
  for (int k = 1; k < 60; ++k) {
    const bool dark = k >= 25 && k < 45;
    const OdometryReport report = journey.step(odometry, k, !dark);
    EXPECT_EQ(report.corrected, !dark);
    EXPECT_FALSE(report.broke);
    EXPECT_EQ(report.step.state == State::kDeadReckoning, dark);
    // Two seconds with a velocity that is 2 cm/s off and biases that are 0.01 m/s^2 off.
    constexpr double kDarkS = 2.0;
    constexpr double kBridgedM = 0.02 * kDarkS + 0.5 * 0.01 * kDarkS * kDarkS;
    EXPECT_LT(journey.error_m(report, first, k), dark ? kBridgedM : 2 * kDriftM) << "scan " << k;
  }
}

TEST(Odometry, ABlackoutThatTheImuCannotBridgeIsABreak) {
  const Journey rest;
  Odometry::Setup poor = setup();
  poor.imu = {1e-2, 0.5, 1e-3, 1e-2};
  Odometry odometry(poor);
  for (int k = 0; k < 10; ++k) rest.step(odometry, k);
  // Out of its rest, so that nothing but the IMU tells where it is.
  odometry.add_imu({kStart + kRevolution * 10 + kRevolution / 2, Vector3d(0, 0, 1), -kGravity});
  int breaks = 0;
  OdometryReport report;
  for (int k = 10; k < 80; ++k) {
    report = rest.step(odometry, k, k >= 60);
    breaks += report.broke ? 1 : 0;
  }
  EXPECT_EQ(breaks, 1);
  EXPECT_EQ(report.step.odom_epoch, 1);
  EXPECT_TRUE(report.corrected);
}

TEST(Odometry, ACrowdIsNoBreak) {
  const Journey rest;
  Odometry odometry(setup());
  const SE3 first = rest.step(odometry, 0).step.T_map_body;
  for (int k = 1; k < 40; ++k) {
    rest.feed_imu(odometry, k);
    Scan scan = rest.scan(k);
    for (std::size_t i = 0; k >= 15 && i < scan.points.size(); ++i) {
      // From scan 15 on, people at 1.5 m hide half of the room; they walk round.
      if ((i / 16 + 5 * static_cast<std::size_t>(k)) % 90 >= 45) continue;
      ScanPoint& p = scan.points[i];
      const float shrink = 1.5F / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
      if (shrink > 1) continue;
      p.x *= shrink;
      p.y *= shrink;
      p.z *= shrink;
    }
    const OdometryReport report = odometry.add_scan(scan);
    EXPECT_FALSE(report.broke) << "scan " << k;
    EXPECT_LT(rest.error_m(report, first, k), 2 * kDriftM) << "scan " << k;
  }
}

TEST(Odometry, WithoutImuOrReturnsNothingIsClaimedToBeKnown) {
  const Journey rest;
  Odometry odometry(setup());
  EXPECT_EQ(odometry.add_scan(rest.scan(0)).step.state, State::kInitializing);
  rest.feed_imu(odometry, 0);
  const OdometryReport dark = rest.step(odometry, 1, false);
  EXPECT_EQ(dark.step.state, State::kDeadReckoning);
  EXPECT_EQ(dark.step.reason, "no returns");
  EXPECT_EQ(rest.step(odometry, 2).step.state, State::kTracking);
  // A scan of the past changes nothing.
  const SE3 before = odometry.state().T_map_body;
  EXPECT_EQ(odometry.add_scan(rest.scan(1)).step.state, State::kDeadReckoning);
  EXPECT_EQ(odometry.state().T_map_body.translation, before.translation);
}

TEST(Odometry, BitsDoNotDependOnTheNumberOfThreads) {
  Journey journey;
  journey.v_map = {0.5, 0.2, 0};
  Odometry one(setup(1)), two(setup(2));
  for (int k = 0; k < 15; ++k) {
    const OdometryReport a = journey.step(one, k);
    const OdometryReport b = journey.step(two, k);
    EXPECT_EQ(a.step.T_map_body.translation, b.step.T_map_body.translation);
    EXPECT_EQ(a.step.T_map_body.rotation.coeffs(), b.step.T_map_body.rotation.coeffs());
    ASSERT_EQ(a.increment.has_value(), b.increment.has_value());
    if (!a.increment) continue;
    EXPECT_EQ(a.increment->covariance, b.increment->covariance);
  }
}

}  // namespace
}  // namespace holdfast::odometry
