#include "simulation/sensors/lidar_model.hpp"

#include <numbers>

namespace holdfast::simulation {

LidarModel LidarModel::rs16() {
  constexpr double kDegree = std::numbers::pi / 180;
  constexpr TimeNs kFiringStep = 2800;
  LidarModel model;
  for (std::uint16_t channel = 0; channel < 16; ++channel) {
    const auto ring = static_cast<std::uint16_t>(channel < 8 ? channel : 23 - channel);
    model.beams.push_back({(-15.0 + 2.0 * ring) * kDegree, channel * kFiringStep, ring});
  }
  model.T_body_lidar.translation = {0.10, 0.0, 0.15};
  model.T_body_lidar.rotation =
      so3::exp(Eigen::Vector3d(0.4 * kDegree, -0.8 * kDegree, 1.2 * kDegree));
  return model;
}

}  // namespace holdfast::simulation
