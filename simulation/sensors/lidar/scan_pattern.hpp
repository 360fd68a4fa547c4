#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "simulation/sensors/lidar/lidar_model.hpp"

namespace holdfast::simulation {

/// When the columns of a frame start, from the start of the frame.
std::vector<TimeNs> column_times(const LidarModel& model);

/// Where the rays of a frame point in the lidar frame, [column][beam]: the same in all frames of a
/// LiDAR that spins, others in each frame of a rosette.
std::vector<Eigen::Vector3f> ray_directions(const LidarModel& model, std::size_t frame);

}  // namespace holdfast::simulation
