#include "simulation/faults.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace holdfast::simulation {
namespace {

void apply_lidar(SimulationOptions& options) { options.lidar.faults = LidarFaults::usual(); }

void apply_imu(SimulationOptions& options) { options.imu = options.imu.with_usual_faults(); }

void apply_clock(SimulationOptions& options) {
  options.transport.lidar_clock = TransportModel::unsynchronised_clock();
}

void apply_packets(SimulationOptions& options) {
  options.transport = options.transport.with_losses();
}

void apply_extrinsics(SimulationOptions& options) {
  options.extrinsics_error = ExtrinsicsError::by_hand();
}

std::string known_names() {
  std::string names;
  for (const FaultPreset& preset : fault_presets()) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", preset.name);
  }
  return names;
}

/// The pieces between commas.
std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> pieces;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    pieces.push_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return pieces;
}

}  // namespace

const std::vector<FaultPreset>& fault_presets() {
  static const std::vector<FaultPreset> kPresets = {
      {"lidar",
       "ranges that are noisier far away and on tilted surfaces, limited reach, drop-outs, mixed "
       "pixels at edges, ghosts behind glass and polished floors, multipath in corners",
       apply_lidar},
      {"imu",
       "bias instability, scale, misalignment, saturation, rounding and vibration of an "
       "industrial MEMS",
       apply_imu},
      {"clock", "the LiDAR's clock is off by some 5 ms, drifts by some 20 ppm and jitters",
       apply_clock},
      {"packets", "2 % of LiDAR packets and 1 % of IMU samples are lost", apply_packets},
      {"extrinsics", "config.yaml states T_body_lidar 1 cm and 0.3 degrees off", apply_extrinsics},
  };
  return kPresets;
}

Status apply_faults(const std::string& names, SimulationOptions& options) {
  const auto& presets = fault_presets();
  std::vector<const FaultPreset*> chosen;
  for (const std::string& name : split(names)) {
    const auto found = std::find_if(presets.begin(), presets.end(),
                                    [&](const auto& preset) { return preset.name == name; });
    if (found == presets.end()) {
      return Error{fmt::format("unknown fault '{}'; known are: {}", name, known_names())};
    }
    chosen.push_back(&*found);
  }
  for (const FaultPreset* preset : chosen) preset->apply(options);
  return Done{};
}

}  // namespace holdfast::simulation
