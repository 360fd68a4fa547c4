#include "simulation/transport/transport_model.hpp"

namespace holdfast::simulation {

LidarClockModel TransportModel::unsynchronised_clock() {
  LidarClockModel clock;
  clock.offset_sigma_s = 0.005;
  clock.drift_sigma_ppm = 20;
  clock.jitter_sigma_s = 0.0005;
  return clock;
}

TransportModel TransportModel::with_losses() const {
  TransportModel model = *this;
  model.lidar_packets = {0.02, 3};
  model.imu_samples = {0.01, 2};
  return model;
}

}  // namespace holdfast::simulation
