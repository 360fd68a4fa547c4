#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "simulation/simulation.hpp"

/// What the simulator's tests share.
namespace holdfast::simulation::testing {

struct Log {
  std::vector<ImuSample> imu;
  std::vector<Scan> scans;
};

inline std::unique_ptr<Simulation> make(const SimulationOptions& options) {
  auto simulation = Simulation::create(options);
  if (simulation) return std::move(*simulation);
  ADD_FAILURE() << simulation.error().message;
  std::abort();
}

/// Runs the simulation to its end.
inline Log record(Simulation& simulation) {
  Log log;
  while (true) {
    auto event = simulation.next();
    if (!event || !event->has_value()) return log;
    if (auto* scan = std::get_if<Scan>(&**event))
      log.scans.push_back(std::move(*scan));
    else
      log.imu.push_back(std::get<ImuSample>(**event));
  }
}

/// A drive without noise: every ray returns its exact range, the IMU is perfect.
inline SimulationOptions noise_free(const std::string& scenario, double duration_s) {
  SimulationOptions options;
  options.scenario = scenario;
  options.duration_s = duration_s;
  options.imu = ImuModel::perfect();
  options.lidar.range_sigma_m = 0;
  return options;
}

inline EventSpec event(const std::string& text) {
  const auto spec = parse_event(text);
  if (!spec) ADD_FAILURE() << spec.error().message;
  return *spec;
}

inline Eigen::Vector3d position(const ScanPoint& p) { return {p.x, p.y, p.z}; }

}  // namespace holdfast::simulation::testing
