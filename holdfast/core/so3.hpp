#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Rotations of SO(3) as unit quaternions; perturbations act on the right: R * exp(phi).
/// Closed forms after Sola et al., "A micro Lie theory", 2018, eqs. 132, 133, 143, 144.
namespace holdfast::so3 {

/// Skew-symmetric matrix with hat(a) * b = a x b.
Eigen::Matrix3d hat(const Eigen::Vector3d& a);

/// Rotation by |phi| radians about phi.
Eigen::Quaterniond exp(const Eigen::Vector3d& phi);

/// Rotation vector of norm <= pi with exp(log(q)) = +-q. `q` has unit norm.
Eigen::Vector3d log(const Eigen::Quaterniond& q);

/// J_r with exp(phi + d) ~ exp(phi) * exp(J_r * d).
Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& phi);

/// Inverse of right_jacobian; defined for |phi| < 2 pi.
Eigen::Matrix3d right_jacobian_inverse(const Eigen::Vector3d& phi);

/// Angle between two rotations in radians, 0 to pi.
double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

}  // namespace holdfast::so3
