#include "holdfast/core/so3.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "tests/core/rotations.hpp"
#include "tests/tolerances.hpp"

namespace holdfast::testing {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using tolerances::kRounding;

constexpr double kPi = std::numbers::pi;

/// Central differences of a function of the tangent space at zero.
Matrix3d differentiate(const std::function<Vector3d(const Vector3d&)>& f) {
  Matrix3d jacobian;
  const double h = tolerances::kDifferenceStep;
  for (int k = 0; k < 3; ++k) {
    const Vector3d d = h * Vector3d::Unit(k);
    jacobian.col(k) = (f(d) - f(-d)) / (2 * h);
  }
  return jacobian;
}

double largest_difference(const Matrix3d& a, const Matrix3d& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

TEST(So3Hat, IsTheCrossProduct) {
  const Vector3d a(1, -2, 3);
  const Vector3d b(0.5, 4, -1);
  EXPECT_EQ(so3::hat(a) * b, a.cross(b));
  EXPECT_EQ(so3::hat(a), -so3::hat(a).transpose());
}

TEST(So3Exp, TurnsByTheRightHandRule) {
  const Quaterniond q = so3::exp({0, 0, kPi / 2});
  EXPECT_NEAR((q * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 0, kRounding);
}

TEST(So3Exp, IsRodriguesFormula) {
  for (const Vector3d& phi : rotation_vectors()) {
    const double angle = phi.norm();
    const Matrix3d k = so3::hat(angle > 0 ? Vector3d(phi / angle) : Vector3d::Zero());
    const double versine = 2 * std::sin(angle / 2) * std::sin(angle / 2);
    const Matrix3d rotation = Matrix3d::Identity() + std::sin(angle) * k + versine * k * k;
    EXPECT_LE(largest_difference(so3::exp(phi).toRotationMatrix(), rotation), kRounding)
        << phi.transpose();
  }
}

TEST(So3Exp, HasUnitNorm) {
  for (const Vector3d& phi : rotation_vectors()) {
    EXPECT_NEAR(so3::exp(phi).norm(), 1.0, kRounding) << phi.transpose();
  }
}

TEST(So3Log, InvertsExp) {
  for (const Vector3d& phi : rotation_vectors()) {
    const double error = (so3::log(so3::exp(phi)) - phi).norm();
    EXPECT_LE(error, tolerances::kNearPi * (1 + phi.norm())) << phi.transpose();
  }
}

TEST(So3Log, KeepsRelativePrecisionOfTinyRotations) {
  const Vector3d phi(3e-12, -4e-12, 0);
  EXPECT_LE((so3::log(so3::exp(phi)) - phi).norm(), kRounding * phi.norm());
}

TEST(So3Log, OfBothQuaternionsOfARotationIsTheSame) {
  for (const Vector3d& phi : rotation_vectors()) {
    const Quaterniond q = so3::exp(phi);
    EXPECT_EQ(so3::log(Quaterniond(-q.coeffs())), so3::log(q)) << phi.transpose();
  }
}

TEST(So3Log, OfAHalfTurnGivesThatHalfTurn) {
  for (const Vector3d& axis : {Vector3d::UnitX().eval(), Vector3d(1, 2, -2).eval()}) {
    const Quaterniond half_turn(0, axis.normalized().x(), axis.normalized().y(),
                                axis.normalized().z());
    const Vector3d phi = so3::log(half_turn);
    EXPECT_NEAR(phi.norm(), kPi, kRounding);
    EXPECT_LE(so3::angle_between(so3::exp(phi), half_turn), tolerances::kNearPi);
  }
}

TEST(So3RightJacobian, IsTheDerivativeOfExp) {
  for (const Vector3d& phi : rotation_vectors()) {
    const Quaterniond inverse = so3::exp(phi).conjugate();
    const Matrix3d numeric =
        differentiate([&](const Vector3d& d) { return so3::log(inverse * so3::exp(phi + d)); });
    EXPECT_LE(largest_difference(so3::right_jacobian(phi), numeric), tolerances::difference_error())
        << phi.transpose();
  }
}

TEST(So3RightJacobianInverse, IsTheDerivativeOfLog) {
  for (const Vector3d& phi : rotation_vectors()) {
    // log jumps at pi: only where the differences stay on one side of it.
    if (phi.norm() > kPi - 2 * tolerances::kDifferenceStep) continue;
    const Quaterniond q = so3::exp(phi);
    const Matrix3d numeric =
        differentiate([&](const Vector3d& d) { return so3::log(q * so3::exp(d)); });
    EXPECT_LE(largest_difference(so3::right_jacobian_inverse(phi), numeric),
              tolerances::difference_error(1.0, tolerances::kNearPi * (1 + phi.norm())))
        << phi.transpose();
  }
}

TEST(So3RightJacobianInverse, InvertsTheRightJacobian) {
  // (1 - cos a) / a^2 loses eps / a^2 of its 1/2 above the small angle of 1e-4, and is multiplied
  // by a: at most eps / 1e-4.
  const double cancellation = tolerances::kEps / 1e-4;
  for (const Vector3d& phi : rotation_vectors()) {
    const Matrix3d product = so3::right_jacobian(phi) * so3::right_jacobian_inverse(phi);
    EXPECT_LE(largest_difference(product, Matrix3d::Identity()), kRounding + cancellation)
        << phi.transpose();
  }
}

TEST(So3AngleBetween, IsTheAngleOfTheRelativeRotation) {
  RandomStream random(2, "angles");
  for (const double angle : {0.0, 1e-9, 0.3, 2.0, kPi}) {
    const Quaterniond a = so3::exp(2.0 * random_direction(random));
    const Quaterniond b = a * so3::exp(angle * random_direction(random));
    EXPECT_NEAR(so3::angle_between(a, b), angle, kRounding);
    EXPECT_NEAR(so3::angle_between(b, a), angle, kRounding);
    EXPECT_NEAR(so3::angle_between(a, Quaterniond(-b.coeffs())), angle, kRounding);
  }
}

}  // namespace
}  // namespace holdfast::testing
