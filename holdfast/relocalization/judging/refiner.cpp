#include "holdfast/relocalization/judging/refiner.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace holdfast::relocalization {
namespace {

using registration::Matrix6d;
using registration::Vector6d;

constexpr std::array<RefineStage, 2> kRough = {
    {{2, 1.0F, 0.3F, 3, true}, {1, 0.5F, 0.1F, 3, true}}};
constexpr RefineStage kHeights = {0, 0.3F, 0.05F, 0, false};
constexpr std::array<RefineStage, 1> kFine = {{{0, 0.3F, 0.03F, 4, false}}};
constexpr std::array<RefineStage, 2> kFull = {
    {{0, 0.3F, 0.02F, 4, false}, {0, 0.3F, 0.004F, 8, false}}};
constexpr int kHeightSteps = 5;  // up and down
constexpr double kHeightStepM = 0.1;

constexpr double kRobustScale = 3.0;
constexpr double kLeastWeight = 20.0;
constexpr double kTiltSigma = std::numbers::pi / 180.0;
constexpr double kHeldTiltSigma = 0.005;
constexpr double kHeldSigmaM = 0.01;
// Of the mode, wide: they only hold what the points leave open.
constexpr double kStartSigmaM = 1.0;
constexpr double kStartSigmaRad = 0.1;
constexpr double kConvergedM = 1e-4;
constexpr double kConvergedRad = 1e-5;

}  // namespace

Refined Refiner::roughly(const Sight& sight, const SE3& T_map_body) {
  Refined refined = descend(sight, kRough, T_map_body);
  if (refined.usable) choose_height(sight, refined);
  return refined;
}

Refined Refiner::finely(const Sight& sight, const SE3& T_map_body) {
  return descend(sight, kFine, T_map_body);
}

Refined Refiner::fully(const Sight& sight, const SE3& T_map_body) {
  Refined refined = descend(sight, kFull, T_map_body);
  refined.pairs = pairs_;
  return refined;
}

Refined Refiner::descend(const Sight& sight, std::span<const RefineStage> stages,
                         const SE3& T_map_body) {
  Refined refined{T_map_body, {}, {}, 0, sight.points.size() > 0};
  for (const RefineStage& stage : stages) {
    for (int i = 0; refined.usable && i < stage.iterations; ++i) {
      match(sight, stage, refined.T_map_body);
      refined.usable = equations_.weight >= kLeastWeight;
      if (!refined.usable || step(sight, T_map_body, stage.level_held, refined.T_map_body)) break;
    }
  }
  match(sight, stages.back(), refined.T_map_body);
  refined.equations = equations_;
  refined.agreeing_share =
      equations_.weight / static_cast<double>(std::max<std::size_t>(1, sight.points.size()));
  return refined;
}

/// The height at which most points lie on planes: floors and ceilings may be two sides of a slab.
void Refiner::choose_height(const Sight& sight, Refined& refined) {
  const Eigen::Vector3d up = -map_.info().gravity_map.normalized();
  const SE3 middle = refined.T_map_body;
  double most = -1;
  for (int k = -kHeightSteps; k <= kHeightSteps; ++k) {
    const SE3 T{middle.rotation, middle.translation + kHeightStepM * k * up};
    match(sight, kHeights, T);
    if (equations_.weight <= most) continue;
    most = equations_.weight;
    refined.T_map_body = T;
  }
  refined.agreeing_share = most / static_cast<double>(sight.points.size());
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
bool Refiner::step(const Sight& sight, const SE3& start, bool level_held, SE3& T_map_body) {
  Matrix6d A = equations_.H.topLeftCorner<6, 6>();
  Vector6d b = equations_.g.head<6>();
  // Gravity in the body frame, R^T g: turning by phi changes it by (R^T g) x phi.
  const Eigen::Vector3d g = map_.info().gravity_map.normalized();
  const Eigen::Vector3d down = T_map_body.rotation.conjugate() * g;
  const Eigen::Matrix3d J = so3::hat(down);
  const double by_tilt = std::pow(level_held ? kHeldTiltSigma : kTiltSigma, -2);
  A.bottomRightCorner<3, 3>() += by_tilt * J.transpose() * J;
  b.tail<3>() += by_tilt * J.transpose() * (down - sight.gravity_body);
  const double by_yaw = std::pow(kStartSigmaRad, -2);
  A.diagonal().tail<3>().array() += by_yaw;
  b.tail<3>() += by_yaw * so3::log(start.rotation.conjugate() * T_map_body.rotation);
  Eigen::Matrix3d by_place = std::pow(kStartSigmaM, -2) * Eigen::Matrix3d::Identity();
  if (level_held) by_place += std::pow(kHeldSigmaM, -2) * g * g.transpose();
  A.topLeftCorner<3, 3>() += by_place;
  b.head<3>() += by_place * (T_map_body.translation - start.translation);
  const Vector6d delta = -A.ldlt().solve(b);
  T_map_body = registration::moved(T_map_body, delta);
  return delta.head<3>().norm() < kConvergedM && delta.tail<3>().norm() < kConvergedRad;
}

}  // namespace holdfast::relocalization
