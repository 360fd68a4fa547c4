#pragma once

#include <string>
#include <vector>

#include "holdfast/core/result.hpp"
#include "simulation/simulation_options.hpp"

namespace holdfast::apps {

/// Turns on the faults of these names, each of which changes the options in its own way and none
/// what another one changes. The error lists the known names; then nothing has changed.
Status apply_faults(const std::vector<std::string>& names, simulation::SimulationOptions& options);

/// Help of --faults: the names with what they turn on.
std::string faults_help();

}  // namespace holdfast::apps
