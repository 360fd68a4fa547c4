#include "holdfast/filter/matching/patch_error.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace holdfast::filter {
namespace {

constexpr std::size_t kSlots = 1 << 13;  // a power of two, more than there are patches in a scan
constexpr std::size_t kMostUsed = kSlots * 3 / 4;
constexpr double kLeastShare = 1e-9;  // of the largest curvature, where the scene tells nothing

/// Never 0.
std::uint64_t key_of(const Eigen::Vector3f& p, Eigen::Index axis) {
  std::uint64_t key = static_cast<std::uint64_t>(axis) + 1;
  for (int i = 0; i < 3; ++i) {
    const auto cell = static_cast<std::int32_t>(std::floor(p[i] / PatchError::kPatchM));
    key = key << 20 | (static_cast<std::uint32_t>(cell) & 0xFFFFFU);
  }
  return key;
}

std::size_t slot_of(std::uint64_t key) {
  return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15U) >> 51) & (kSlots - 1);
}

}  // namespace

/// The last slot that is free takes all patches that find none: they count as one.
PatchError::Patch& PatchError::patch_of(std::uint64_t key) {
  std::size_t slot = slot_of(key);
  while (table_[slot].key != key) {
    if (table_[slot].key == 0) {
      if (used_.size() >= kMostUsed) return table_[used_.back()];
      table_[slot].key = key;
      used_.push_back(static_cast<std::uint32_t>(slot));
      break;
    }
    slot = (slot + 1) & (kSlots - 1);
  }
  return table_[slot];
}

void PatchError::sum_up(const registration::Correspondences& pairs, const SE3& T_anchor_body,
                        double robust_scale, const PatchModel& model) {
  table_.resize(kSlots);
  for (const std::uint32_t slot : used_) table_[slot] = {};
  used_.clear();
  const Eigen::Matrix3f R = T_anchor_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f t = T_anchor_body.translation.cast<float>();
  const auto scale_sq = static_cast<float>(robust_scale * robust_scale);
  const float range_sq = model.range_sigma_m * model.range_sigma_m;
  const float rest_sq = model.surface_sigma_m * model.surface_sigma_m +
                        static_cast<float>(model.noise_m * model.noise_m);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const float information = pairs.information[i];
    if (information <= 0) continue;
    const Eigen::Vector3f n(pairs.nx[i], pairs.ny[i], pairs.nz[i]);
    const Eigen::Vector3f q(pairs.px[i], pairs.py[i], pairs.pz[i]);
    const Eigen::Vector3f p = R * q + t;
    const float r = n.dot(p) - pairs.offset[i];
    const float shrink = scale_sq / (scale_sq + r * r * information);
    const float weight = shrink * shrink * information;
    Eigen::Index axis = 0;
    n.cwiseAbs().maxCoeff(&axis);
    // Normals have arbitrary signs, but the patch is off in one direction.
    const float signed_weight = n[axis] < 0 ? -weight : weight;
    const Eigen::Vector3f u = R.transpose() * n;
    const Eigen::Vector3f ray = q - model.p_body_lidar;
    const float along = u.dot(ray);
    Patch& patch = patch_of(key_of(p, axis));
    patch.sum.head<3>() += signed_weight * n;
    patch.sum.tail<3>() += signed_weight * q.cross(u);
    patch.weight += weight;
    patch.excess +=
        weight * (1.0F / information - range_sq * along * along / ray.squaredNorm() - rest_sq);
  }
}

Matrix6d PatchError::of(const registration::Correspondences& pairs, const SE3& T_anchor_body,
                        double robust_scale, const Matrix6d& H, const PatchModel& model) {
  sum_up(pairs, T_anchor_body, robust_scale, model);
  Matrix6d outer = Matrix6d::Zero();
  for (const std::uint32_t slot : used_) {
    const Patch& patch = table_[slot];
    const Eigen::Matrix<double, 6, 1> J = patch.sum.cast<double>();
    const double excess = std::max(0.0F, patch.excess / patch.weight);
    outer.noalias() += model.share * model.share * excess * J * J.transpose();
  }
  Matrix6d damped = H;
  damped.diagonal().array() += kLeastShare * H.diagonal().maxCoeff();
  const Eigen::LDLT<Matrix6d> solver(damped);
  const Matrix6d covariance = solver.solve(solver.solve(outer).transpose());
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace holdfast::filter
