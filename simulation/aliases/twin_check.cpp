#include "simulation/aliases/twin_check.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace holdfast::simulation {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr int kSteps = 14;
constexpr double kWidest = 0.5;  // metres
constexpr double kNarrowing = 0.6;
constexpr double kGrazing = 0.1;  // cosine below which a range says little about the pose
constexpr double kFarStep = 0.5;  // metres and radians that a step may go
constexpr double kManySigmas = 4;
constexpr double kBeyond = 6.334e-5;  // share of a normal distribution beyond 4 sigma

}  // namespace

TwinCheck::Step TwinCheck::step(const RangeImage& seen, const SE3& T_map_image,
                                double scale) const {
  const RangeImage image = render(caster_, rays_, T_map_image);
  Matrix4d H = 1e-6 * static_cast<double>(rays_.size()) * Matrix4d::Identity();
  Vector4d b = Vector4d::Zero();
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    if (std::max(image.range[i], seen.range[i]) > rays_.max_range_m) continue;
    const Vector3d direction = T_map_image.rotation * rays_.direction(i);
    const Vector3d normal = normal_of(world_, image.surface[i]);
    const double along = normal.dot(direction);
    if (std::abs(along) < kGrazing) continue;
    // The plane n (o + r d) = c: moving by x and turning by w, dr = -n (x + r w z x d) / (n d).
    const Vector3d lever = image.range[i] * Vector3d(-direction.y(), direction.x(), 0);
    Vector4d J;
    J.head<3>() = -normal / along;
    J[3] = -normal.dot(lever) / along;
    const double error = image.range[i] - seen.range[i];
    const double relative = error / scale;
    const double weight = 1 / ((1 + relative * relative) * (1 + relative * relative));
    H += weight * J * J.transpose();
    b += weight * error * J;
  }
  Step step;
  step.motion = -H.ldlt().solve(b);
  const double far = std::max(step.motion.head<3>().norm(), std::abs(step.motion[3])) / kFarStep;
  if (far > 1) step.motion /= far;
  return step;
}

SE3 TwinCheck::refined(const RangeImage& seen, const SE3& T_map_image) const {
  SE3 pose = T_map_image;
  double scale = kWidest;
  for (int i = 0; i < kSteps; ++i, scale = std::max(sigma_m_, kNarrowing * scale)) {
    const Vector4d motion = step(seen, pose, scale).motion;
    pose.translation += motion.head<3>();
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(motion[3], Vector3d::UnitZ()));
    pose.rotation = (turn * pose.rotation).normalized();
  }
  return pose;
}

/// Rays whose range lies outside of what the `other` image shows around the same pixel.
std::size_t TwinCheck::outside(const std::vector<float>& range,
                               const std::vector<float>& other) const {
  const auto rows = static_cast<std::ptrdiff_t>(rays_.elevations.size());
  const auto columns = static_cast<std::ptrdiff_t>(rays_.columns);
  const auto slack = static_cast<float>(kManySigmas * sigma_m_);
  std::size_t count = 0;
  for (std::ptrdiff_t row = 0; row < rows; ++row) {
    for (std::ptrdiff_t column = 0; column < columns; ++column) {
      const std::ptrdiff_t here = row * columns + column;
      if (std::abs(range[here] - other[here]) <= slack) continue;
      float low = other[here], high = other[here];
      for (std::ptrdiff_t r = std::max<std::ptrdiff_t>(0, row - 1);
           r <= std::min(rows - 1, row + 1); ++r) {
        for (std::ptrdiff_t c = column - 1; c <= column + 1; ++c) {
          const float there = other[r * columns + (c + columns) % columns];
          low = std::min(low, there);
          high = std::max(high, there);
        }
      }
      count += range[here] < low - slack || range[here] > high + slack ? 1U : 0U;
    }
  }
  return count;
}

std::size_t TwinCheck::differing(const RangeImage& seen, const SE3& T_map_image) const {
  const RangeImage image = render(caster_, rays_, T_map_image);
  return std::max(outside(image.range, seen.range), outside(seen.range, image.range));
}

std::size_t TwinCheck::explained_by_noise() const {
  const double expected = kBeyond * static_cast<double>(rays_.size());
  return static_cast<std::size_t>(expected + kManySigmas * std::sqrt(expected));
}

}  // namespace holdfast::simulation
