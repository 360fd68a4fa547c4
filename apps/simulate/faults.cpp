#include "apps/simulate/faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace holdfast::apps {
namespace {

using simulation::SimulationOptions;

struct Fault {
  std::string_view name;
  std::string_view summary;
  void (*apply)(SimulationOptions& options);
};

void imu(SimulationOptions& options) { options.imu = options.imu.with_usual_faults(); }

void clock(SimulationOptions& options) {
  options.transport.lidar_clock = simulation::TransportModel::unsynchronised_clock();
}

void packets(SimulationOptions& options) { options.transport = options.transport.with_losses(); }

void extrinsics(SimulationOptions& options) {
  options.extrinsics_error = simulation::ExtrinsicsError::by_hand();
}

constexpr std::array kFaults = {
    Fault{"imu",
          "bias instability, scale, misalignment, saturation, rounding and vibration of an "
          "industrial MEMS",
          imu},
    Fault{"clock", "the LiDAR's clock is off by some 5 ms, drifts by some 20 ppm and jitters",
          clock},
    Fault{"packets", "2 % of LiDAR packets and 1 % of IMU samples are lost", packets},
    Fault{"extrinsics", "config.yaml states T_body_lidar 1 cm and 0.3 degrees off", extrinsics},
};

const Fault* find(std::string_view name) {
  const auto* found = std::find_if(kFaults.begin(), kFaults.end(),
                                   [name](const Fault& fault) { return fault.name == name; });
  return found == kFaults.end() ? nullptr : found;
}

}  // namespace

Status apply_faults(const std::vector<std::string>& names, SimulationOptions& options) {
  for (const std::string& name : names) {
    if (find(name)) continue;
    std::string known;
    for (const Fault& fault : kFaults)
      known += fmt::format("{}{}", known.empty() ? "" : ", ", fault.name);
    return Error{fmt::format("unknown fault '{}'; known are: {}", name, known)};
  }
  for (const Fault& fault : kFaults) {
    if (std::find(names.begin(), names.end(), fault.name) != names.end()) fault.apply(options);
  }
  return Done{};
}

std::string faults_help() {
  std::string help = "what goes wrong with sensors, separated by commas:";
  std::string_view comma = " ";
  for (const Fault& fault : kFaults) {
    help += fmt::format("{}{} ({})", comma, fault.name, fault.summary);
    comma = ", ";
  }
  return help;
}

}  // namespace holdfast::apps
