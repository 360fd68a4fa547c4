#include "simulation/sensors/lidar/lidar_model.hpp"

#include <numbers>

namespace holdfast::simulation {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Where each model is mounted.
SE3 mounting() {
  return {so3::exp(Eigen::Vector3d(0.4 * kDegree, -0.8 * kDegree, 1.2 * kDegree)),
          {0.10, 0.0, 0.15}};
}

}  // namespace

LidarModel LidarModel::rs16() {
  constexpr TimeNs kFiringStep = 2800;
  LidarModel model;
  for (std::uint16_t channel = 0; channel < 16; ++channel) {
    const auto ring = static_cast<std::uint16_t>(channel < 8 ? channel : 23 - channel);
    model.beams.push_back({(-15.0 + 2.0 * ring) * kDegree, channel * kFiringStep, ring});
  }
  model.T_body_lidar = mounting();
  return model;
}

LidarModel LidarModel::os1_128() {
  constexpr std::uint16_t kBeams = 128;
  constexpr double kField = 45.0;
  LidarModel model;
  for (std::uint16_t ring = 0; ring < kBeams; ++ring) {
    model.beams.push_back({kField * (ring / (kBeams - 1.0) - 0.5) * kDegree, 0, ring});
  }
  model.columns = 1024;
  model.reach_at_10_percent_m = 45;  // its data sheet (for 9 of 10 returns)
  model.T_body_lidar = mounting();
  return model;
}

}  // namespace holdfast::simulation
