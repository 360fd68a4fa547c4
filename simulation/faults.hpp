#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "holdfast/core/result.hpp"
#include "simulation/simulation_options.hpp"

namespace holdfast::simulation {

/// Faults that can be asked for by name, each with the sizes that are usual for real sensors.
struct FaultPreset {
  std::string_view name;
  std::string_view summary;
  void (*apply)(SimulationOptions& options);
};

/// All of them, in the order in which the help shows them.
const std::vector<FaultPreset>& fault_presets();

/// Applies the presets that a list names, separated by commas. An unknown name is an error that
/// lists the known ones, and leaves the options as they were.
Status apply_faults(const std::string& names, SimulationOptions& options);

}  // namespace holdfast::simulation
