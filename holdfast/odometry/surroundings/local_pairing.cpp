#include "holdfast/odometry/surroundings/local_pairing.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "holdfast/registration/degeneracy.hpp"

namespace holdfast::odometry {
namespace {

constexpr double kWeakShare = 0.02;    // of all information, below which a direction is weak
constexpr double kRobustScale = 12.0;  // wide: the pose is still a prediction

/// Takes `u` out of the normals that are at right angles to it but for `sine`; the distances at
/// `T_anchor_body` stay as they are.
void take_out(const Eigen::Vector3f& u, float sine, const SE3& T_anchor_body,
              registration::Correspondences& c) {
  const Eigen::Vector3f u_body =
      (T_anchor_body.rotation.conjugate() * u.cast<double>()).cast<float>();
  const float place = u.dot(T_anchor_body.translation.cast<float>());
  for (std::size_t i = 0; i < c.size(); ++i) {
    float along = u.x() * c.nx[i] + u.y() * c.ny[i] + u.z() * c.nz[i];
    along = std::abs(along) < sine ? along : 0.0F;
    const float at = u_body.x() * c.px[i] + u_body.y() * c.py[i] + u_body.z() * c.pz[i] + place;
    c.nx[i] -= along * u.x();
    c.ny[i] -= along * u.y();
    c.nz[i] -= along * u.z();
    c.offset[i] -= along * at;
  }
}

}  // namespace

std::size_t LocalPairing::associate(const SE3& T_anchor_body, const Eigen::Vector3d& p_body_lidar,
                                    const registration::BodyPoints& points,
                                    const registration::AssociationOptions& options,
                                    WorkerPool& pool, registration::Correspondences& out) const {
  const std::size_t pairs =
      registration::associate(map_, T_anchor_body, p_body_lidar, points, options, pool, out);
  const auto equations = registration::linearise(out, T_anchor_body, kRobustScale, pool, partials_);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      registration::position_information(equations.H));
  const double least = kWeakShare * solver.eigenvalues().sum();
  for (int i = 0; i < 2; ++i) {
    if (solver.eigenvalues()[i] >= least) break;
    take_out(solver.eigenvectors().col(i).cast<float>(), static_cast<float>(parallel_sine_),
             T_anchor_body, out);
  }
  return pairs;
}

}  // namespace holdfast::odometry
