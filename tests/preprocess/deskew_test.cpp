#include "holdfast/preprocess/deskew.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "tests/tolerances.hpp"

namespace holdfast::preprocess {
namespace {

constexpr TimeNs kStamp = 1'700'000'000 * kSecond + 123'456'789;
constexpr TimeNs kSpan = kSecond / 10;
constexpr double kGravity = 9.81;

// A float holds a coordinate of 10 m to 0.5e-6; rotating and adding takes a handful of roundings.
constexpr double kFloatAt10m = 6e-6;

/// Readings each 5 ms over the scan (one more at its end).
ImuSegment readings(const std::function<ImuSample(double)>& at_seconds_before_end) {
  ImuSegment segment;
  for (int i = 0; i <= 20; ++i) {
    ImuSample sample = at_seconds_before_end(0.1 - 0.005 * i);
    sample.t = kStamp + kSpan * i / 20;
    segment.samples.push_back(sample);
  }
  return segment;
}

ImuSample reading(const Eigen::Vector3d& gyro, const Eigen::Vector3d& accel) {
  return {0, gyro, accel};
}

SE3 some_extrinsic() { return {so3::exp({0.02, -0.03, 1.2}), {0.3, -0.1, 0.8}}; }

/// Ten points all around, ten metres away, measured at `share` of the scan.
std::vector<ScanPoint> points_at(double share, double range = 10.0) {
  std::vector<ScanPoint> points;
  for (int k = 0; k < 10; ++k) {
    const double azimuth = 2 * M_PI * k / 10;
    ScanPoint p;
    p.x = static_cast<float>(range * 0.96 * std::cos(azimuth));
    p.y = static_cast<float>(range * 0.96 * std::sin(azimuth));
    p.z = static_cast<float>(range * 0.28 * (k % 2 == 0 ? 1 : -1));
    p.time_offset_ns = static_cast<std::int32_t>(share * static_cast<double>(kSpan));
    points.push_back(p);
  }
  return points;
}

Eigen::Vector3d position(const ScanPoint& p) { return {p.x, p.y, p.z}; }

/// Compares with T_end_body(t) in closed form, t in seconds before the end.
void expect_motion(const ScanMotion& motion, const SE3& T_body_lidar,
                   const std::function<SE3(double)>& T_end_body, double range, double tolerance) {
  for (int k = 0; k <= 200; ++k) {
    const double share = k / 200.0;
    for (const ScanPoint& p : points_at(share, range)) {
      const double age = to_seconds(kSpan - p.time_offset_ns);
      const Eigen::Vector3d expected = T_end_body(age) * (T_body_lidar * position(p));
      ASSERT_LT((motion.deskew(p).cast<double>() - expected).norm(), tolerance)
          << "at " << share << " of the scan";
    }
  }
}

TEST(ScanMotion, AtRestPointsOnlyChangeIntoTheBodyFrame) {
  const SE3 T_body_lidar = some_extrinsic();
  const SE3 T_map_body{so3::exp({0.1, -0.2, 0.5}), Eigen::Vector3d::Zero()};
  EndState end;
  end.gravity_end = T_map_body.rotation.conjugate() * Eigen::Vector3d(0, 0, -kGravity);
  ScanMotion motion;
  motion.set(readings([&](double) {
               return reading({0, 0, 0}, -end.gravity_end);
             }),
             end, T_body_lidar, kStamp, kStamp + kSpan);
  expect_motion(
      motion, T_body_lidar, [](double) { return SE3{}; }, 10.0, kFloatAt10m);
}

TEST(ScanMotion, BiasesAreTakenOffTheReadings) {
  EndState end;
  end.gravity_end = {0, 0, -kGravity};
  end.gyro_bias = {0.2, -0.1, 0.3};
  end.accel_bias = {0.5, 0.4, -0.3};
  ScanMotion motion;
  motion.set(
      readings([&](double) { return reading(end.gyro_bias, end.accel_bias - end.gravity_end); }),
      end, SE3{}, kStamp, kStamp + kSpan);
  expect_motion(
      motion, SE3{}, [](double) { return SE3{}; }, 10.0, kFloatAt10m);
}

TEST(ScanMotion, ConstantVelocityMovesPointsBackByTheirAge) {
  const SE3 T_body_lidar = some_extrinsic();
  EndState end;
  end.v_end = {11.0, -2.0, 0.5};
  end.gravity_end = {0, 0, -kGravity};
  ScanMotion motion;
  motion.set(readings([&](double) {
               return reading({0, 0, 0}, {0, 0, kGravity});
             }),
             end, T_body_lidar, kStamp, kStamp + kSpan);
  expect_motion(
      motion, T_body_lidar,
      [&](double age) {
        return SE3{Eigen::Quaterniond::Identity(), -age * end.v_end};
      },
      10.0, kFloatAt10m);
}

TEST(ScanMotion, ConstantAccelerationIsAParabola) {
  EndState end;
  end.v_end = {5.0, 0, 0};
  end.gravity_end = {0, 0, -kGravity};
  const Eigen::Vector3d a(-6.0, 2.0, 0.5);
  ScanMotion motion;
  motion.set(readings([&](double) {
               return reading({0, 0, 0}, a - end.gravity_end);
             }),
             end, SE3{}, kStamp, kStamp + kSpan);
  // A point between two knots (0.1 s / 63 apart) is moved to first order; what is left of the
  // parabola over one knot is a dt^2 / 8, at the one-sided first knot too.
  const double knot = 0.1 / (ScanMotion::kKnots - 1);
  expect_motion(
      motion, SE3{},
      [&](double age) {
        return SE3{Eigen::Quaterniond::Identity(), -age * end.v_end + 0.5 * age * age * a};
      },
      10.0, kFloatAt10m + a.norm() * knot * knot / 8);
}

TEST(ScanMotion, TurningOnTheSpotSwingsTheLidarAroundTheBody) {
  const SE3 T_body_lidar = some_extrinsic();
  const Eigen::Vector3d rate(0, 0, 1.0);
  EndState end;
  end.gravity_end = {0, 0, -kGravity};
  ScanMotion motion;
  motion.set(readings([&](double) {
               return reading(rate, {0, 0, kGravity});
             }),
             end, T_body_lidar, kStamp, kStamp + kSpan);
  // The lever arm is 0.3 m and the points are 10 m away: the remainder of first order between knots
  // is (rate dt)^2 / 8 of that.
  const double angle = rate.norm() * 0.1 / (ScanMotion::kKnots - 1);
  expect_motion(
      motion, T_body_lidar,
      [&](double age) {
        return SE3{so3::exp(-age * rate), Eigen::Vector3d::Zero()};
      },
      10.0, kFloatAt10m + 11 * angle * angle / 8);
}

TEST(ScanMotion, ACircleDrivenAtConstantSpeedIsAnArc) {
  const SE3 T_body_lidar = some_extrinsic();
  const Eigen::Vector3d rate(0, 0, 0.8);
  EndState end;
  end.v_end = {8.0, 0, 0};
  end.gravity_end = {0, 0, -kGravity};
  const Eigen::Vector3d centripetal = rate.cross(end.v_end);
  ScanMotion motion;
  motion.set(readings([&](double) { return reading(rate, centripetal - end.gravity_end); }), end,
             T_body_lidar, kStamp, kStamp + kSpan);
  // The midpoint rule errs by a (rate dt)^2 / 24 in the acceleration; the first order between knots
  // by a dt^2 / 8 and (rate dt)^2 / 8 of 11 m.
  const double knot = 0.1 / (ScanMotion::kKnots - 1);
  const double midpoint = centripetal.norm() * std::pow(rate.norm() * 0.005, 2) / 24 * 0.01 / 2;
  const double first_order = (centripetal.norm() + 11 * rate.squaredNorm()) * knot * knot / 8;
  expect_motion(
      motion, T_body_lidar,
      [&](double age) {
        const double w = rate.z();
        const double radius = end.v_end.x() / w;
        const double turned = -w * age;  // heading at the age, seen from the end
        return SE3{so3::exp(-age * rate),
                   {radius * std::sin(turned), radius * (1 - std::cos(turned)), 0}};
      },
      10.0, kFloatAt10m + midpoint + first_order);
}

TEST(ScanMotion, AtThreeRadiansASecondAndFiftyMetresTheRemainderIsBelowAFifthOfAMillimetre) {
  const Eigen::Vector3d rate(0, 0, 3.0);
  EndState end;
  end.gravity_end = {0, 0, -kGravity};
  ScanMotion motion;
  motion.set(readings([&](double) {
               return reading(rate, {0, 0, kGravity});
             }),
             end, SE3{}, kStamp, kStamp + kSpan);
  expect_motion(
      motion, SE3{},
      [&](double age) {
        return SE3{so3::exp(-age * rate), Eigen::Vector3d::Zero()};
      },
      50.0, 2e-4);
}

TEST(ScanMotion, PosesAtKnotsAreThoseOfTheMotion) {
  const Eigen::Vector3d rate(0.4, -0.3, 1.0);
  EndState end;  // free fall: no specific force, no gravity
  end.v_end = {1.0, 2.0, 3.0};
  ScanMotion motion;
  motion.set(readings([&](double) {
               return reading(rate, {0, 0, 0});
             }),
             end, SE3{}, kStamp, kStamp + kSpan);
  ASSERT_EQ(motion.knot_poses().size(), static_cast<std::size_t>(ScanMotion::kKnots));
  for (std::size_t k = 0; k < motion.knot_poses().size(); ++k) {
    const TimeNs t = kSpan * static_cast<TimeNs>(k) / (ScanMotion::kKnots - 1);
    const double age = to_seconds(kSpan - t);
    const SE3& T = motion.knot_poses()[k];
    // 20 steps of a few roundings each.
    EXPECT_LT((T.translation + age * end.v_end).norm(), 20 * tolerances::kRounding);
    EXPECT_LT(so3::angle_between(T.rotation, so3::exp(-age * rate)), 20 * tolerances::kRounding);
  }
}

TEST(ScanMotion, AScanWithoutPointTimesOnlyChangesIntoTheBodyFrame) {
  // io gives such a scan offsets of zero and an end at its stamp.
  const SE3 T_body_lidar = some_extrinsic();
  EndState end;
  end.v_end = {11.0, 0, 0};
  end.gravity_end = {0, 0, -kGravity};
  ImuSegment segment;
  segment.samples.push_back(reading({0, 0, 1.0}, {0, 0, kGravity}));
  segment.samples.back().t = kStamp;
  ScanMotion motion;
  motion.set(segment, end, T_body_lidar, kStamp, kStamp);
  for (const ScanPoint& p : points_at(0.0)) {
    EXPECT_LT((motion.deskew(p).cast<double>() - T_body_lidar * position(p)).norm(), kFloatAt10m);
  }
}

TEST(ScanMotion, PointsOutsideOfTheScansTimesStayFinite) {
  EndState end;
  end.v_end = {2.0, 0, 0};
  end.gravity_end = {0, 0, -kGravity};
  ScanMotion motion;
  motion.set(readings([&](double) {
               return reading({0, 0, 0}, {0, 0, kGravity});
             }),
             end, SE3{}, kStamp, kStamp + kSpan);
  for (const std::int32_t offset : {-50'000'000, 150'000'000}) {
    ScanPoint p;
    p.x = 10;
    p.time_offset_ns = offset;
    // Carried on at the same velocity.
    const double age = to_seconds(kSpan - offset);
    EXPECT_NEAR(motion.deskew(p).x(), 10 - age * end.v_end.x(), kFloatAt10m);
  }
}

}  // namespace
}  // namespace holdfast::preprocess
