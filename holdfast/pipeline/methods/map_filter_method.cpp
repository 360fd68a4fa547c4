#include "holdfast/pipeline/methods/map_filter_method.hpp"

#include <numbers>

namespace holdfast::pipeline {

baselines::MapFilter::Setup filter_setup(const Config& config, int threads) {
  baselines::MapFilter::Setup setup;
  setup.filter = config.map_filter;
  setup.imu = config.imu;
  setup.selection = config.preprocess;
  setup.start = {config.start.position_m, config.start.rotation_deg * std::numbers::pi / 180.0,
                 config.start.speed_m_s};
  setup.range_sigma_m = config.lidar.range_sigma_m;
  setup.T_body_lidar = config.T_body_lidar;
  setup.threads = threads;
  return setup;
}

}  // namespace holdfast::pipeline
