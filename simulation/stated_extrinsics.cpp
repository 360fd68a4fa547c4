#include "simulation/stated_extrinsics.hpp"

#include <numbers>

#include "holdfast/core/random.hpp"
#include "simulation/sensors/imu/normal_vector.hpp"

namespace holdfast::simulation {

ExtrinsicsError ExtrinsicsError::by_hand() { return {0.01, 0.3 * std::numbers::pi / 180}; }

SE3 stated_extrinsics(const SE3& T_body_lidar, const ExtrinsicsError& error, std::uint64_t seed) {
  if (error.is_none()) return T_body_lidar;
  RandomStream random(seed, "config.extrinsics");
  const Eigen::Vector3d way = error.position_m * normal_vector(random).normalized();
  const Eigen::Vector3d turn = error.angle_rad * normal_vector(random).normalized();
  return T_body_lidar * SE3{so3::exp(turn), way};
}

}  // namespace holdfast::simulation
