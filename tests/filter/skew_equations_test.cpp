#include "holdfast/filter/matching/skew_equations.hpp"

#include <gtest/gtest.h>

#include <tuple>

#include "holdfast/core/random.hpp"
#include "holdfast/preprocess/deskew.hpp"
#include "holdfast/registration/normal_equations.hpp"

namespace holdfast::filter {
namespace {

constexpr TimeNs kStamp = 5 * kSecond;
constexpr TimeNs kEnd = kStamp + kSecond / 10;
const Eigen::Vector3d kGravity(0, 0, -9.81);

Eigen::Vector3d random_vector(RandomStream& random, double scale) {
  return scale * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
}

/// Points that a body in slow motion measured on planes of any direction, a little off them. Of a
/// slow body the derivatives by the motion are those of a body at rest.
struct SlowScan {
  SlowScan() {
    RandomStream random(1, "slow scan");
    x.T_map_body = {so3::exp(random_vector(random, 1.0)), random_vector(random, 3.0)};
    x.v_map = random_vector(random, 1e-3);
    x.t = kEnd;
    const Eigen::Vector3d force = -(x.T_map_body.rotation.conjugate() * kGravity);
    imu.samples = {{kStamp, random_vector(random, 1e-3), force},
                   {kEnd, random_vector(random, 1e-3), force}};
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector3f p = random_vector(random, 8.0).cast<float>();
      scan.points.push_back({.x = p.x(), .y = p.y(), .z = p.z(), .time_offset_ns = i * 250000});
      normals.push_back(random_vector(random, 1.0).normalized());
      noise.push_back(0.02 * random.normal());
    }
    pairs = pairs_at(x);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Eigen::Vector3d q(pairs.px[i], pairs.py[i], pairs.pz[i]);
      pairs.offset[i] = static_cast<float>(normals[i].dot(x.T_map_body * q) + noise[i]);
    }
  }

  /// The pairs with the points moved as a body with the state `at` moved.
  registration::Correspondences pairs_at(const FilterState& at) const {
    const Eigen::Quaterniond R_body_map = at.T_map_body.rotation.conjugate();
    preprocess::ScanMotion motion;
    motion.set(imu, {R_body_map * at.v_map, R_body_map * kGravity, at.gyro_bias, at.accel_bias},
               SE3{}, kStamp, kEnd);
    registration::Correspondences out = pairs;
    out.resize(scan.points.size());
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Eigen::Vector3f q = motion.deskew(scan.points[i]);
      std::tie(out.px[i], out.py[i], out.pz[i]) = std::tuple(q.x(), q.y(), q.z());
      const Eigen::Vector3f n = normals[i].cast<float>();
      std::tie(out.nx[i], out.ny[i], out.nz[i]) = std::tuple(n.x(), n.y(), n.z());
      out.information[i] = 1.0F;
      out.age_s[i] = static_cast<float>(scan.points[i].time_offset_ns) * 1e-9F - 0.1F;
    }
    return out;
  }

  /// Residuals at `at`, in double.
  Eigen::VectorXd residuals(const FilterState& at) const {
    const auto moved = pairs_at(at);
    Eigen::VectorXd r(static_cast<Eigen::Index>(moved.size()));
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const Eigen::Vector3d q(moved.px[i], moved.py[i], moved.pz[i]);
      r[static_cast<Eigen::Index>(i)] = normals[i].dot(at.T_map_body * q) - pairs.offset[i];
    }
    return r;
  }

  FilterState x;
  preprocess::ImuSegment imu;
  Scan scan;
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> noise;
  registration::Correspondences pairs;
};

TEST(LinearisedWithSkew, AreThoseOfTheDerivativesOfDeskewedPoints) {
  const SlowScan s;
  constexpr double kWide = 1e6;  // of the robust loss: no point counts less than another
  const auto [H, g] = linearise_with_skew(s.pairs, s.x.T_map_body, kWide);
  // A step that moves a point by about 1 cm: the points are floats.
  constexpr double kSteps[] = {0.01, 0.001, 0.1, 2.0, 0.02};
  Eigen::Matrix<double, Eigen::Dynamic, 15> J(400, 15);
  for (int k = 0; k < 15; ++k) {
    Vector15d d = Vector15d::Zero();
    d[k] = kSteps[k / 3];
    FilterState up = s.x;
    FilterState down = s.x;
    up.add(d);
    down.add(-d);
    J.col(k) = (s.residuals(up) - s.residuals(down)) / (2 * kSteps[k / 3]);
  }
  const Eigen::VectorXd r = s.residuals(s.x);
  for (int k = 0; k < 15; ++k) {
    const double scale = J.col(k).norm();
    ASSERT_GT(scale, 1e-3);
    EXPECT_NEAR(H(k, k) / (scale * scale), 1.0, 0.02) << "unknown " << k;
    EXPECT_NEAR(g[k] / scale, J.col(k).dot(r) / scale, 0.02 * r.norm()) << "unknown " << k;
    for (int l = 0; l < k; ++l) {
      EXPECT_NEAR(H(k, l), J.col(k).dot(J.col(l)), 0.02 * scale * J.col(l).norm());
    }
  }
}

TEST(LinearisedWithSkew, AgreeWithThoseOfPoseAndVelocityAndTheirRobustWeights) {
  const SlowScan s;
  constexpr double kNarrow = 0.02;
  const auto [H, g] = linearise_with_skew(s.pairs, s.x.T_map_body, kNarrow);
  WorkerPool pool(1);
  std::vector<registration::NormalEquations> partials;
  const auto e = registration::linearise(s.pairs, s.x.T_map_body, kNarrow, pool, partials);
  EXPECT_LT((H.topLeftCorner<9, 9>() - e.H).norm(), 1e-4 * e.H.norm());
  EXPECT_LT((g.head<9>() - e.g).norm(), 1e-3 * e.g.norm());
}

}  // namespace
}  // namespace holdfast::filter
