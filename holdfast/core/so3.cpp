#include "holdfast/core/so3.hpp"

#include <cmath>

namespace holdfast::so3 {
namespace {

// Below this angle the Taylor terms kept are exact to double precision.
constexpr double kSmallAngle = 1e-4;

}  // namespace

Eigen::Matrix3d hat(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

Eigen::Quaterniond exp(const Eigen::Vector3d& phi) {
  const double angle_sq = phi.squaredNorm();
  const double angle = std::sqrt(angle_sq);
  const double half_sinc =
      angle < kSmallAngle ? 0.5 - angle_sq / 48.0 : std::sin(0.5 * angle) / angle;
  const double w = angle < kSmallAngle ? 1.0 - angle_sq / 8.0 : std::cos(0.5 * angle);
  return {w, half_sinc * phi.x(), half_sinc * phi.y(), half_sinc * phi.z()};
}

Eigen::Vector3d log(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const double norm = q.vec().norm();
  const double w = sign * q.w();
  if (norm < kSmallAngle) return sign * (2.0 / w - 2.0 * norm * norm / (3.0 * w * w * w)) * q.vec();
  return sign * (2.0 * std::atan2(norm, w) / norm) * q.vec();
}

Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& phi) {
  const double angle_sq = phi.squaredNorm();
  const double angle = std::sqrt(angle_sq);
  const Eigen::Matrix3d k = hat(phi);
  if (angle < kSmallAngle) {
    return Eigen::Matrix3d::Identity() - (0.5 - angle_sq / 24.0) * k + (1.0 / 6.0) * k * k;
  }
  return Eigen::Matrix3d::Identity() - (1.0 - std::cos(angle)) / angle_sq * k +
         (angle - std::sin(angle)) / (angle_sq * angle) * k * k;
}

Eigen::Matrix3d right_jacobian_inverse(const Eigen::Vector3d& phi) {
  const double angle_sq = phi.squaredNorm();
  const double angle = std::sqrt(angle_sq);
  const Eigen::Matrix3d k = hat(phi);
  const double half = 0.5 * angle;
  const double c = angle < kSmallAngle ? 1.0 / 12.0 + angle_sq / 720.0
                                       : (1.0 - half * std::cos(half) / std::sin(half)) / angle_sq;
  return Eigen::Matrix3d::Identity() + 0.5 * k + c * k * k;
}

double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return log(a.conjugate() * b).norm();
}

}  // namespace holdfast::so3
