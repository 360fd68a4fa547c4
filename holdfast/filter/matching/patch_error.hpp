#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/filter/matching/map_error.hpp"

namespace holdfast::filter {

/// How far off the surfaces of a map are.
struct PatchModel {
  double share = 1;             ///< of its excess thickness, by which a surface is off
  double noise_m = 0;           ///< of the map's points: what makes a plane thick that is one
  float range_sigma_m = 0.02F;  ///< as the pairs were weighted with
  float surface_sigma_m = 0.003F;
  Eigen::Vector3f p_body_lidar = Eigen::Vector3f::Zero();
};

/// How far a map whose surfaces are all a little off moves a scan. A plane of a map was fitted to
/// few points, or stands for what is not quite a plane, as thick as it is beyond the noise of its
/// points: all returns from it are wrong by the same, so that a thousand of them tell no more than
/// the plane is good for. What is taken for one surface are the pairs within kPatchM of each other
/// whose normals share their largest axis.
class PatchError {
 public:
  static constexpr float kPatchM = 1.0F;

  /// Covariance of the pose error, in the order of MapError::pose: H^-1 (sum of s^2 J J^T over the
  /// patches) H^-1, where s is how far a patch is off, J the sum of the weighted Jacobians of its
  /// pairs, and H the curvature by the pose of the whole scan. Robust weights as in
  /// registration::linearise.
  Matrix6d of(const registration::Correspondences& pairs, const SE3& T_anchor_body,
              double robust_scale, const Matrix6d& H, const PatchModel& model);

 private:
  struct Patch {
    std::uint64_t key = 0;
    Eigen::Matrix<float, 6, 1> sum = Eigen::Matrix<float, 6, 1>::Zero();
    float weight = 0;
    float excess = 0;  ///< sum of weight * (thickness^2 - noise^2)
  };

  void sum_up(const registration::Correspondences& pairs, const SE3& T_anchor_body,
              double robust_scale, const PatchModel& model);
  Patch& patch_of(std::uint64_t key);

  std::vector<Patch> table_;
  std::vector<std::uint32_t> used_;
};

}  // namespace holdfast::filter
