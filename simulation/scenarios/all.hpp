#pragma once

#include <string_view>

#include "simulation/scenario.hpp"

/// The scenarios, one source file or one scenario file (.yaml) each.
namespace holdfast::simulation {

/// The text of a scenario file in this folder ("garage.yaml").
std::string_view scenario_text(std::string_view file);

Scenario make_campus();
Scenario make_lift();
Scenario make_town();
Scenario make_garage();
Scenario make_box();
Scenario make_corridor();
Scenario make_office();
Scenario make_hall();
Scenario make_warehouse();
Scenario make_yard();
Scenario make_tunnel();
Scenario make_offices();

}  // namespace holdfast::simulation
