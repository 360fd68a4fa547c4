#include "holdfast/relocalization/judging/refiner.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <numbers>

namespace holdfast::relocalization {
namespace {

using registration::Matrix6d;
using registration::Vector6d;

constexpr std::array<RefineStage, 3> kRough = {
    {{2, 1.0F, 0.3F, 3}, {1, 0.5F, 0.1F, 3}, {0, 0.3F, 0.03F, 2}}};
constexpr std::array<RefineStage, 4> kFull = {
    {{2, 1.0F, 0.3F, 3}, {1, 0.5F, 0.1F, 4}, {0, 0.3F, 0.02F, 4}, {0, 0.3F, 0.004F, 8}}};

constexpr double kRobustScale = 3.0;
constexpr double kLeastWeight = 20.0;
constexpr double kTiltSigma = std::numbers::pi / 180.0;
// Of the mode, wide: they only hold what the points leave open.
constexpr double kStartSigmaM = 1.0;
constexpr double kStartSigmaRad = 0.1;
constexpr double kConvergedM = 1e-4;
constexpr double kConvergedRad = 1e-5;

}  // namespace

Refined Refiner::roughly(const Sight& sight, const SE3& T_map_body) {
  Refined refined{T_map_body, {}, {}, 0, false};
  descend(sight, kRough, refined);
  return refined;
}

Refined Refiner::fully(const Sight& sight, const SE3& T_map_body) {
  Refined refined{T_map_body, {}, {}, 0, false};
  descend(sight, kFull, refined);
  refined.pairs = pairs_;
  return refined;
}

void Refiner::descend(const Sight& sight, std::span<const RefineStage> stages, Refined& refined) {
  refined.usable = sight.points.size() > 0;
  for (const RefineStage& stage : stages) {
    const SE3 start = refined.T_map_body;
    for (int i = 0; refined.usable && i < stage.iterations; ++i) {
      match(sight, stage, refined.T_map_body);
      refined.usable = equations_.weight >= kLeastWeight;
      if (!refined.usable || step(sight, start, refined.T_map_body)) break;
    }
  }
  match(sight, stages.back(), refined.T_map_body);
  refined.equations = equations_;
  refined.agreeing_share =
      equations_.weight / static_cast<double>(std::max<std::size_t>(1, sight.points.size()));
}

void Refiner::match(const Sight& sight, const RefineStage& stage, const SE3& T_map_body) {
  registration::AssociationOptions how;
  how.level = stage.level;
  how.gate_m = stage.gate_m;
  how.surface_sigma_m = stage.surface_sigma_m;
  how.range_sigma_m = static_cast<float>(sight.range_sigma_m);
  if (stage.surface_sigma_m > 0.01F) how.ambiguity_sigmas = 0;
  const SE3 T_anchor_body{T_map_body.rotation, T_map_body.translation - map_.anchor()};
  registration::associate(map_, T_anchor_body, sight.p_body_lidar, sight.points, how, alone_,
                          pairs_);
  equations_ = registration::linearise(pairs_, T_anchor_body, kRobustScale, alone_, partials_);
  work_ += sight.points.size();
}

/// One step of Gauss-Newton; true when it was too small to matter.
bool Refiner::step(const Sight& sight, const SE3& start, SE3& T_map_body) {
  Matrix6d A = equations_.H.topLeftCorner<6, 6>();
  Vector6d b = equations_.g.head<6>();
  // Gravity in the body frame, R^T g: turning by phi changes it by (R^T g) x phi.
  const Eigen::Vector3d down = T_map_body.rotation.conjugate() * map_.info().gravity_map.normalized();
  const Eigen::Matrix3d J = so3::hat(down);
  A.bottomRightCorner<3, 3>() += J.transpose() * J / (kTiltSigma * kTiltSigma);
  b.tail<3>() += J.transpose() * (down - sight.gravity_body) / (kTiltSigma * kTiltSigma);
  const double position = 1.0 / (kStartSigmaM * kStartSigmaM);
  const double rotation = 1.0 / (kStartSigmaRad * kStartSigmaRad);
  A.diagonal().head<3>().array() += position;
  A.diagonal().tail<3>().array() += rotation;
  b.head<3>() += position * (T_map_body.translation - start.translation);
  b.tail<3>() += rotation * so3::log(start.rotation.conjugate() * T_map_body.rotation);
  const Vector6d delta = -A.ldlt().solve(b);
  T_map_body = registration::moved(T_map_body, delta);
  return delta.head<3>().norm() < kConvergedM && delta.tail<3>().norm() < kConvergedRad;
}

}  // namespace holdfast::relocalization
